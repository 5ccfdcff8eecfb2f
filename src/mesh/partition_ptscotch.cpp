#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/petsc.hpp"

#include <petscmat.h>

#include "dual_graph.hpp"
#include "transfer.hpp"
#include <algorithm>
#include <string>

namespace evert {

#ifndef PETSC_HAVE_PTSCOTCH

std::vector<int> partition_by_ptscotch(MPI_Comm /*comm*/, const Mesh& /*mesh*/) {
  throw UserError("this PETSc was built without PT-Scotch: use the partitioner metis");
}

#else
namespace {

using PartitioningHandle = PetscHandle<MatPartitioning, MatPartitioningDestroy>;

/// Consecutive cells of the dual graph on one rank.
struct GraphRows {
  std::vector<PetscInt> offsets;
  std::vector<PetscInt> neighbours;
  std::vector<PetscInt> weights;
};

GraphRows rows_between(const DualGraph& graph, const std::vector<PetscInt>& weights, std::size_t begin,
                       std::size_t end) {
  GraphRows rows;
  const auto base = graph.offsets[begin];
  for (std::size_t row = begin; row <= end; ++row) rows.offsets.push_back(graph.offsets[row] - base);
  rows.neighbours.assign(graph.neighbours.get() + base, graph.neighbours.get() + graph.offsets[end]);
  // PETSc wants them ascending.
  for (std::size_t row = 0; row + 1 < rows.offsets.size(); ++row)
    std::sort(rows.neighbours.begin() + rows.offsets[row], rows.neighbours.begin() + rows.offsets[row + 1]);
  rows.weights.assign(weights.begin() + static_cast<std::ptrdiff_t>(begin),
                      weights.begin() + static_cast<std::ptrdiff_t>(end));
  return rows;
}

/// Collective. Deals the rows of rank 0's dual graph out in equal shares.
GraphRows deal_out_rows(MPI_Comm comm, const DualGraph& graph, const Mesh& mesh) {
  if (rank_of(comm) != 0)
    return {receive<PetscInt>(comm, 0), receive<PetscInt>(comm, 0), receive<PetscInt>(comm, 0)};
  const auto weights = cell_weights<PetscInt>(mesh);
  const auto ranks = static_cast<std::size_t>(size_of(comm));
  const auto first_row = [&](std::size_t rank) { return weights.size() * rank / ranks; };
  for (std::size_t rank = 1; rank < ranks; ++rank) {
    const auto rows = rows_between(graph, weights, first_row(rank), first_row(rank + 1));
    send(comm, static_cast<int>(rank), rows.offsets);
    send(comm, static_cast<int>(rank), rows.neighbours);
    send(comm, static_cast<int>(rank), rows.weights);
  }
  return rows_between(graph, weights, 0, first_row(1));
}

/// A copy for PETSc calls that keep an array and free it.
PetscInt* petsc_copy(const std::vector<PetscInt>& values) {
  PetscInt* copy = nullptr;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"  // inside PETSc's macro
  check(PetscMalloc1(values.size(), &copy));
#pragma GCC diagnostic pop
  std::copy(values.begin(), values.end(), copy);
  return copy;
}

/// Collective. Rank 0 gets everyone's values, in the order of ranks.
std::vector<int> gather_to_root(MPI_Comm comm, const std::vector<int>& values) {
  if (rank_of(comm) != 0) {
    send(comm, 0, values);
    return {};
  }
  auto all = values;
  for (int rank = 1; rank < size_of(comm); ++rank) {
    const auto more = receive<int>(comm, rank);
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

}  // namespace

std::vector<int> partition_by_ptscotch(MPI_Comm comm, const Mesh& mesh) {
  DualGraph graph;
  on_root(comm, [&] { graph = dual_graph(mesh); });
  const GraphRows rows = deal_out_rows(comm, graph, mesh);
  auto cells = static_cast<PetscInt>(rows.weights.size());
  PetscInt all_cells = 0;
  MPI_Allreduce(&cells, &all_cells, 1, MPIU_INT, MPI_SUM, comm);
  MatHandle adjacency;
  check(MatCreateMPIAdj(comm, cells, all_cells, petsc_copy(rows.offsets), petsc_copy(rows.neighbours),
                        nullptr, adjacency.out()));
  PartitioningHandle partitioning;
  check(MatPartitioningCreate(comm, partitioning.out()));
  check(MatPartitioningSetAdjacency(partitioning.get(), adjacency.get()));
  check(MatPartitioningSetType(partitioning.get(), MATPARTITIONINGPTSCOTCH));
  check(MatPartitioningSetVertexWeights(partitioning.get(), petsc_copy(rows.weights)));
  IsHandle ranks_of_cells;
  check(MatPartitioningApply(partitioning.get(), ranks_of_cells.out()));
  const PetscInt* indices = nullptr;
  check(ISGetIndices(ranks_of_cells.get(), &indices));
  const std::vector<int> mine(indices, indices + cells);
  check(ISRestoreIndices(ranks_of_cells.get(), &indices));
  return gather_to_root(comm, mine);
}

#endif
}  // namespace evert
