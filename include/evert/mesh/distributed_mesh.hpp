#pragma once
#include "evert/core/aligned.hpp"
#include "evert/core/index.hpp"
#include "evert/core/petsc.hpp"
#include "evert/mesh/mesh.hpp"
#include "evert/mesh/partition.hpp"

#include <mpi.h>

#include <span>
#include <string>
#include <vector>

/// A mesh spread over the ranks of a communicator: every node and every cell has one owner.
namespace evert {

/// The cells of one type and one region that a rank owns; those that touch only owned nodes come first, so
/// that they can be computed while ghost values travel.
struct LocalCells {
  CellType type = CellType::tet4;
  std::int32_t region = 0;              ///< index into DistributedMesh::regions
  std::vector<LocalIndex> nodes;        ///< local numbers, node_count(type) per cell
  std::vector<GlobalIndex> global_ids;  ///< numbers in the undistributed mesh, all blocks in order
  std::vector<Vec3d> vectors{};         ///< per cell, or empty: those of CellBlock::vectors
  LocalIndex interior = 0;              ///< cells [0, interior) touch no ghost

  [[nodiscard]] LocalIndex size() const { return static_cast<LocalIndex>(global_ids.size()); }
};

/// Sorted local numbers of the nodes of a set on this rank.
struct LocalNodeSet {
  std::string name;
  std::vector<LocalIndex> owned;
};

/// One rank's part. Local node numbers: owned nodes [0, owned_nodes), then ghosts. Owned nodes are numbered
/// for locality (reverse Cuthill-McKee). The PETSc global number of owned node i is first_owned + i.
struct DistributedMesh {
  MPI_Comm comm = MPI_COMM_NULL;
  GlobalIndex total_nodes = 0;
  GlobalIndex total_cells = 0;
  LocalIndex owned_nodes = 0;
  LocalIndex ghost_nodes = 0;
  GlobalIndex first_owned = 0;
  std::vector<GlobalIndex> ghost_globals;   ///< PETSc global numbers of the ghosts
  std::vector<GlobalIndex> original_nodes;  ///< per local node: its number in the undistributed mesh
  std::vector<GlobalIndex> natural_nodes;   ///< per owned node: the same without counting unused nodes
  std::vector<Vec3d> rest_positions;        ///< per local node [m]
  std::vector<LocalCells> cells;            ///< same list (types × regions, some empty) on every rank
  std::vector<std::string> regions;
  std::vector<LocalNodeSet> node_sets;  ///< same names on every rank

  [[nodiscard]] LocalIndex local_nodes() const { return owned_nodes + ghost_nodes; }
};

struct DistributionOptions {
  Partitioner partitioner = Partitioner::metis;
};

/// Collective. Partitions the cells of `mesh` (looked at on rank 0 only) and spreads them; nodes of no cell
/// are dropped. A node shared by several ranks goes to the lowest or the highest of them, by the parity of
/// the two: whole interfaces stay on one side, and the sides take turns. Throws UserError on all ranks when
/// the partitioner fails, when ranks outnumber cells or when PETSc's integers are too short.
[[nodiscard]] DistributedMesh distribute(MPI_Comm comm, const Mesh& mesh,
                                         const DistributionOptions& options = {});

/// Collective. A vector of 3 values per node with room for ghosts (VecCreateGhostBlock with block size 3).
/// Its local array is aligned to 64 bytes and one double longer than PETSc knows, so that a 4-wide load of
/// the last node stays inside.
class NodeField {
 public:
  explicit NodeField(const DistributedMesh& mesh);
  NodeField(NodeField&&) noexcept = default;
  NodeField& operator=(NodeField&&) noexcept = default;

  [[nodiscard]] Vec vec() const { return vec_.get(); }
  /// Owned and ghost values, x y z per node. Writing them directly: call `touched()` afterwards.
  [[nodiscard]] std::span<double> local() {
    return {array_.data(), 3 * static_cast<std::size_t>(local_nodes_)};
  }
  [[nodiscard]] std::span<const double> local() const {
    return {array_.data(), 3 * static_cast<std::size_t>(local_nodes_)};
  }
  /// Owned values only.
  [[nodiscard]] std::span<double> owned() {
    return local().first(3 * static_cast<std::size_t>(owned_nodes_));
  }
  [[nodiscard]] std::span<const double> owned() const {
    return local().first(3 * static_cast<std::size_t>(owned_nodes_));
  }
  /// Tells PETSc that the array was changed behind its back (norm caches).
  void touched();

 private:
  AlignedVector<double> array_;  // owned by us, wrapped by vec_: declared first, destroyed last
  VecHandle vec_;
  LocalIndex owned_nodes_ = 0;
  LocalIndex local_nodes_ = 0;
};

/// The exchange of ghost values, split so that work can be done in between; results are repeatable bit by
/// bit. All calls are collective, and only for fields of the mesh that the halo was made for.
class Halo {
 public:
  explicit Halo(const DistributedMesh& mesh);
  /// owner → ghost copies.
  void begin_update(NodeField& field) const;
  void end_update(NodeField& field) const;
  /// ghost → owner sum; ghosts keep their stale values.
  void begin_add(NodeField& field) const;
  void end_add(NodeField& field) const;

 private:
  void check_belongs(const NodeField& field) const;

  std::size_t local_values_;  // the plan itself is shared by the vectors of the fields
  bool alone_;                // one rank has nothing to exchange, and PETSc would allocate to find out
};

}  // namespace evert
