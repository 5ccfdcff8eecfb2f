#pragma once
#include "evert/mesh/distributed_mesh.hpp"

#include <mpi.h>

#include <string>
#include <utility>
#include <vector>

/// The first half of distribution: rank 0 cuts the mesh into shares and sends each rank its own.
namespace evert {

/// What every rank knows alike.
struct Outline {
  GlobalIndex total_nodes = 0;  ///< without those of no cell
  GlobalIndex total_cells = 0;
  std::vector<std::pair<CellType, std::int32_t>> lists;  ///< type and region of every list of cells
  std::vector<std::string> regions;
  std::vector<std::string> node_sets;
};

/// A node as it travels; all members of 8 bytes, so that no padding does.
struct SharedNode {
  GlobalIndex original;
  GlobalIndex natural;
  std::int64_t owner;
  Vec3d position;
};

/// One rank's cells with the nodes they touch, in numbers of the share: nodes that the rank owns come first,
/// then the others by owner and natural number.
struct Share {
  std::vector<SharedNode> nodes;
  std::vector<LocalCells> cells;        ///< as Outline::lists
  std::vector<LocalNodeSet> node_sets;  ///< as Outline::node_sets
};

/// Collective. `mesh` is looked at on rank 0 only. Throws UserError on all ranks where integers are too
/// short.
[[nodiscard]] Outline share_outline(MPI_Comm comm, const Mesh& mesh);

/// Collective. `part` (the rank of every cell) and `mesh` are looked at on rank 0 only.
[[nodiscard]] Share deal_out(MPI_Comm comm, const Outline& outline, const Mesh& mesh,
                             const std::vector<int>& part);

}  // namespace evert
