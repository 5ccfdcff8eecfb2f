#pragma once
#include "evert/mesh/mesh.hpp"
#include "evert/mesh/partition.hpp"

#include <metis.h>
#include <mpi.h>

#include <memory>
#include <vector>

/// The graph that partitioners cut: cells are joined where they share a face.
namespace evert {

struct MetisFree {
  void operator()(idx_t* array) const { METIS_Free(array); }
};

/// Compressed rows: the neighbours of cell c are neighbours[offsets[c]] to neighbours[offsets[c + 1]].
struct DualGraph {
  std::unique_ptr<idx_t[], MetisFree> offsets;
  std::unique_ptr<idx_t[], MetisFree> neighbours;
};

/// Throws UserError when the mesh outgrows METIS's integers or METIS fails.
[[nodiscard]] DualGraph dual_graph(const Mesh& mesh);

/// Quadrature points of every cell, blocks in order.
template <class Integer>
[[nodiscard]] std::vector<Integer> cell_weights(const Mesh& mesh) {
  std::vector<Integer> weights;
  weights.reserve(static_cast<std::size_t>(mesh.cell_count()));
  for (const auto& block : mesh.cells)
    weights.insert(weights.end(), block.region.size(), static_cast<Integer>(quadrature_points(block.type)));
  return weights;
}

/// Collective. PT-Scotch through PETSc's MatPartitioning; result on rank 0 only, where `mesh` is looked at.
/// Throws UserError on every rank where PETSc was built without it.
[[nodiscard]] std::vector<int> partition_by_ptscotch(MPI_Comm comm, const Mesh& mesh);

}  // namespace evert
