#include "evert/forces/node_matrix.hpp"

#include <array>
#include <string_view>

namespace evert {
namespace {

LocalToGlobalHandle node_numbering(const DistributedMesh& mesh) {
  std::vector<PetscInt> globals;
  globals.reserve(static_cast<std::size_t>(mesh.local_nodes()));
  for (LocalIndex i = 0; i < mesh.owned_nodes; ++i)
    globals.push_back(static_cast<PetscInt>(mesh.first_owned + i));
  for (const auto ghost : mesh.ghost_globals) globals.push_back(static_cast<PetscInt>(ghost));
  LocalToGlobalHandle map;
  check(ISLocalToGlobalMappingCreate(mesh.comm, 3, static_cast<PetscInt>(globals.size()), globals.data(),
                                     PETSC_COPY_VALUES, map.out()));
  return map;
}

MatHandle empty_matrix(const DistributedMesh& mesh, const char* type, ISLocalToGlobalMapping numbering) {
  MatHandle mat;
  const PetscInt rows = 3 * mesh.owned_nodes;
  check(MatCreate(mesh.comm, mat.out()));
  check(MatSetSizes(mat.get(), rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetType(mat.get(), type));
  check(MatSetBlockSize(mat.get(), 3));
  check(MatSetLocalToGlobalMapping(mat.get(), numbering, numbering));
  return mat;
}

}  // namespace

NodeMatrix::NodeMatrix(const DistributedMesh& mesh, const ElasticForces& elastic, const char* type,
                       const std::function<bool(const ElasticBlock&)>& takes_part)
    : mesh_(mesh), upper_only_(std::string_view(type) == MATSBAIJ) {
  preallocate(elastic, type, takes_part);
  attach_rigid_body_modes();
}

/// Adds the matrix of the nodes rows_. A symmetric format gets the blocks on and above the diagonal only:
/// PETSc's own way of dropping the others fails on several ranks.
void NodeMatrix::add_rows(Mat mat, std::span<const double> matrix) {
  const auto n = rows_.size();
  const auto count = static_cast<PetscInt>(n);
  if (!upper_only_) {
    check(MatSetValuesBlockedLocal(mat, count, rows_.data(), count, rows_.data(), matrix.data(), ADD_VALUES));
    return;
  }
  std::array<double, 9> block{};
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      if (global_number(rows_[b]) < global_number(rows_[a])) continue;
      for (std::size_t k = 0; k < 9; ++k) block[k] = matrix[(3 * a + k / 3) * 3 * n + 3 * b + k % 3];
      check(MatSetValuesBlockedLocal(mat, 1, &rows_[a], 1, &rows_[b], block.data(), ADD_VALUES));
    }
}

GlobalIndex NodeMatrix::global_number(PetscInt local) const {
  return local < mesh_.owned_nodes ? mesh_.first_owned + local
                                   : mesh_.ghost_globals[static_cast<std::size_t>(local - mesh_.owned_nodes)];
}

void NodeMatrix::preallocate(const ElasticForces& elastic, const char* type,
                             const std::function<bool(const ElasticBlock&)>& takes_part) {
  const auto numbering = node_numbering(mesh_);
  const auto pattern = empty_matrix(mesh_, MATPREALLOCATOR, numbering.get());
  check(MatSetUp(pattern.get()));
  std::vector<double> zeros(9);
  for (const auto& block : elastic.blocks()) {
    if (block == nullptr || !takes_part(*block)) continue;
    for (LocalIndex cell = 0; cell < block->cells(); ++cell) {
      const auto nodes = block->cell_nodes(cell);
      rows_.assign(nodes.begin(), nodes.end());
      zeros.resize(9 * nodes.size() * nodes.size());
      add_rows(pattern.get(), zeros);
    }
  }
  for (LocalIndex node = 0; node < mesh_.owned_nodes; ++node) {
    rows_.assign(1, node);
    add_rows(pattern.get(), zeros);
  }
  check(MatAssemblyBegin(pattern.get(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(pattern.get(), MAT_FINAL_ASSEMBLY));
  mat_ = empty_matrix(mesh_, type, numbering.get());
  check(MatPreallocatorPreallocate(pattern.get(), PETSC_FALSE, mat_.get()));
  knows_spd_ = std::string_view(type) != MATBAIJ;  // MPIBAIJ does not
  if (knows_spd_) check(MatSetOption(mat_.get(), MAT_SYMMETRIC, PETSC_TRUE));
}

void NodeMatrix::attach_rigid_body_modes() {
  NodeField coordinates(mesh_);
  const auto& rest = mesh_.rest_positions;
  for (std::size_t i = 0; i < coordinates.local().size(); ++i) coordinates.local()[i] = rest[i / 3][i % 3];
  coordinates.touched();
  MatNullSpaceHandle modes;
  check(MatNullSpaceCreateRigidBody(coordinates.vec(), modes.out()));
  check(MatSetNearNullSpace(mat_.get(), modes.get()));
}

void NodeMatrix::declare_positive_definite(bool is) {
  if (knows_spd_) check(MatSetOption(mat_.get(), MAT_SPD, is ? PETSC_TRUE : PETSC_FALSE));
}

void NodeMatrix::begin() { check(MatZeroEntries(mat_.get())); }

void NodeMatrix::add(const CellNodes& cell, std::span<const double> matrix) {
  rows_.assign(cell.begin(), cell.end());
  add_rows(mat_.get(), matrix);
}

void NodeMatrix::add_diagonal(LocalIndex node, std::span<const double, 9> block) {
  rows_.assign(1, node);
  add_rows(mat_.get(), block);
}

void NodeMatrix::end() {
  check(MatAssemblyBegin(mat_.get(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(mat_.get(), MAT_FINAL_ASSEMBLY));
}

}  // namespace evert
