#include "evert/integrators/damping_matrix.hpp"

#include <string_view>

namespace evert {
namespace {

constexpr std::array<double, 9> unit_block{1, 0, 0, 0, 1, 0, 0, 0, 1};

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

AssembledDamping::AssembledDamping(const DampingOperator& damping, const char* type)
    : damping_(damping), upper_only_(std::string_view(type) == MATSBAIJ) {
  for (int column = 0; column < 3; ++column) projectors_.emplace_back(damping.mesh());
  preallocate(type);
  attach_rigid_body_modes();
}

template <class Work>
void AssembledDamping::for_each_cell(Work&& work) {
  for (const auto& block : damping_.elastic().blocks()) {
    if (block == nullptr || !block->damped()) continue;
    for (LocalIndex cell = 0; cell < block->cells(); ++cell) {
      const auto nodes = block->cell_nodes(cell);
      rows_.assign(nodes.begin(), nodes.end());
      cell_.resize(9 * nodes.size() * nodes.size());
      work(*block, cell, nodes);
    }
  }
}

/// Adds cell_, the dense matrix of the nodes rows_ (local numbers). A symmetric format gets the blocks on and
/// above the diagonal only: PETSc's own way of dropping the others fails on several ranks.
void AssembledDamping::add_cell(Mat mat) {
  const auto n = rows_.size();
  const auto count = static_cast<PetscInt>(n);
  if (!upper_only_) {
    check(MatSetValuesBlockedLocal(mat, count, rows_.data(), count, rows_.data(), cell_.data(), ADD_VALUES));
    return;
  }
  std::array<double, 9> block{};
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      if (global_number(rows_[b]) < global_number(rows_[a])) continue;
      for (std::size_t k = 0; k < 9; ++k) block[k] = cell_[(3 * a + k / 3) * 3 * n + 3 * b + k % 3];
      check(MatSetValuesBlockedLocal(mat, 1, &rows_[a], 1, &rows_[b], block.data(), ADD_VALUES));
    }
}

GlobalIndex AssembledDamping::global_number(PetscInt local) const {
  const auto& mesh = damping_.mesh();
  return local < mesh.owned_nodes ? mesh.first_owned + local
                                  : mesh.ghost_globals[static_cast<std::size_t>(local - mesh.owned_nodes)];
}

void AssembledDamping::preallocate(const char* type) {
  const auto& mesh = damping_.mesh();
  const auto numbering = node_numbering(mesh);
  const auto pattern = empty_matrix(mesh, MATPREALLOCATOR, numbering.get());
  check(MatSetUp(pattern.get()));
  for_each_cell([&](const ElasticBlock& /*block*/, LocalIndex /*cell*/,
                    std::span<const LocalIndex> /*nodes*/) { add_cell(pattern.get()); });
  cell_.assign(9, 0.0);
  for (LocalIndex node = 0; node < mesh.owned_nodes; ++node) {  // undamped nodes have their mass
    rows_.assign(1, node);
    add_cell(pattern.get());
  }
  check(MatAssemblyBegin(pattern.get(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(pattern.get(), MAT_FINAL_ASSEMBLY));
  mat_ = empty_matrix(mesh, type, numbering.get());
  check(MatPreallocatorPreallocate(pattern.get(), PETSC_FALSE, mat_.get()));
  if (std::string_view(type) != MATBAIJ)
    check(MatSetOption(mat_.get(), MAT_SPD, PETSC_TRUE));  // unknown to MPIBAIJ
}

void AssembledDamping::attach_rigid_body_modes() {
  NodeField coordinates(damping_.mesh());
  const auto& rest = damping_.mesh().rest_positions;
  for (std::size_t i = 0; i < coordinates.local().size(); ++i) coordinates.local()[i] = rest[i / 3][i % 3];
  coordinates.touched();
  MatNullSpaceHandle modes;
  check(MatNullSpaceCreateRigidBody(coordinates.vec(), modes.out()));
  check(MatSetNearNullSpace(mat_.get(), modes.get()));
}

void AssembledDamping::share_projectors() {
  const auto& halo = damping_.elastic().halo();
  for (std::size_t column = 0; column < 3; ++column) {
    auto& field = projectors_[column];
    auto values = field.owned();
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = unit_block[3 * column + i % 3];
    for (const auto& c : damping_.constraints())
      for (std::size_t k = 0; k < 3; ++k)
        values[3 * static_cast<std::size_t>(c.node) + k] = c.free.column[column][k];
    field.touched();
    halo.begin_update(field);
    halo.end_update(field);
  }
}

/// K_ab ← P_a K_ab P_b for every pair of the cell's nodes.
void AssembledDamping::project_cell(std::span<const LocalIndex> nodes) {
  const auto n = nodes.size();
  const auto p = [&](std::size_t node, std::size_t i, std::size_t j) {
    return projectors_[j].local()[3 * static_cast<std::size_t>(nodes[node]) + i];
  };
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      const auto entry = [&](std::size_t i, std::size_t j) -> double& {
        return cell_[(3 * a + i) * 3 * n + 3 * b + j];
      };
      Mat3d kp{};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          for (std::size_t k = 0; k < 3; ++k) kp(i, j) += entry(i, k) * p(b, k, j);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
          entry(i, j) = 0;
          for (std::size_t k = 0; k < 3; ++k) entry(i, j) += p(a, i, k) * kp(k, j);
        }
    }
}

void AssembledDamping::assemble() {
  share_projectors();
  check(MatZeroEntries(mat_.get()));
  for_each_cell([&](const ElasticBlock& block, LocalIndex cell, std::span<const LocalIndex> nodes) {
    block.damping_matrix(cell, cell_);
    for (auto& entry : cell_) entry *= damping_.factor();
    project_cell(nodes);
    add_cell(mat_.get());
  });
  const auto mass = damping_.elastic().masses();
  const auto mass_damping = damping_.elastic().mass_damping();
  for (std::size_t node = 0; node < mass.size(); ++node) {
    rows_.assign(1, static_cast<PetscInt>(node));
    cell_.assign(9, 0.0);
    const double damped = mass_damping.empty() ? 0.0 : damping_.factor() * mass_damping[node];
    for (std::size_t k = 0; k < 9; ++k)  // P is symmetric: its order is of no matter
      cell_[k] = mass[node] * unit_block[k] + damped * projectors_[k / 3].owned()[3 * node + k % 3];
    add_cell(mat_.get());
  }
  check(MatAssemblyBegin(mat_.get(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(mat_.get(), MAT_FINAL_ASSEMBLY));
}

}  // namespace evert
