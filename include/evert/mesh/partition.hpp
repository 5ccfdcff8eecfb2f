#pragma once
#include "evert/mesh/mesh.hpp"

#include <mpi.h>

#include <vector>

/// Which rank gets which cell.
namespace evert {

enum class Partitioner {
  metis,     ///< serial, on rank 0
  ptscotch,  ///< in parallel, where PETSc was built with PT-Scotch
};

/// Number of quadrature points, the work of a cell.
[[nodiscard]] int quadrature_points(CellType type);

/// Not collective. The rank of every cell (blocks in order) by METIS k-way on the dual graph, weighted by
/// quadrature points; deterministic, and no rank stays without a cell. Throws UserError when ranks outnumber
/// cells, when the mesh is too large for METIS's integers or when METIS fails.
[[nodiscard]] std::vector<int> partition_cells(const Mesh& mesh, int ranks);

/// Collective. The same for the ranks of `comm` by either partitioner; `mesh` is looked at on rank 0 only,
/// and only there the result is not empty. Errors are thrown on every rank.
[[nodiscard]] std::vector<int> partition_cells(MPI_Comm comm, const Mesh& mesh, Partitioner partitioner);

}  // namespace evert
