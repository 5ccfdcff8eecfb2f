#include "evert/filter/mode_energy.hpp"

#include <cmath>

namespace evert {
namespace {

/// Collective. u = M^−½ (M^½ u), ghosts too.
NodeField displacements(const DistributedMesh& mesh, const ElasticForces& elastic, const FastestMode& mode) {
  NodeField u(mesh);
  const PetscScalar* scaled = nullptr;
  check(VecGetArrayRead(mode.scaled.get(), &scaled));
  for (std::size_t i = 0; i < u.owned().size(); ++i)
    u.owned()[i] = scaled[i] / std::sqrt(elastic.masses()[i / 3]);
  check(VecRestoreArrayRead(mode.scaled.get(), &scaled));
  u.touched();
  elastic.halo().begin_update(u);
  elastic.halo().end_update(u);
  return u;
}

double twice_energy(const CellNodes& nodes, std::span<const double> matrix, std::span<const double> u) {
  const auto unknowns = 3 * nodes.size();
  const auto at = [&](std::size_t i) { return u[3 * static_cast<std::size_t>(nodes[i / 3]) + i % 3]; };
  double sum = 0;
  for (std::size_t i = 0; i < unknowns; ++i)
    for (std::size_t j = 0; j < unknowns; ++j) sum += at(i) * matrix[i * unknowns + j] * at(j);
  return sum;
}

}  // namespace

std::vector<std::vector<double>> energy_shares(const DistributedMesh& mesh, const ElasticForces& elastic,
                                               const NodeField& x, const FastestMode& mode) {
  const auto u = displacements(mesh, elastic, mode);
  std::vector<std::vector<double>> shares(mesh.cells.size());
  for (std::size_t e = 0; e < mesh.cells.size(); ++e)
    shares[e].resize(static_cast<std::size_t>(mesh.cells[e].size()));
  for (std::size_t b = 0; b < elastic.blocks().size(); ++b) {
    const auto& block = elastic.blocks()[b];
    if (block == nullptr) continue;
    auto& of_entry = shares[elastic.entry_of(b)];
    const auto numbers = elastic.cells_in(b);
    block->stiffness_matrices(
        x.local().data(), TangentForm::full, [&](LocalIndex cell, std::span<const double> matrix) {
          of_entry[static_cast<std::size_t>(numbers[static_cast<std::size_t>(cell)])] =
              twice_energy(block->cell_nodes(cell), matrix, u.local()) / mode.squared_frequency;
        });
  }
  return shares;
}

}  // namespace evert
