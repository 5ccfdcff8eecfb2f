#include "evert/integrators/damping_matrix.hpp"

#include <algorithm>

namespace evert {
namespace {

constexpr std::array<double, 9> unit_block{1, 0, 0, 0, 1, 0, 0, 0, 1};

}  // namespace

AssembledDamping::AssembledDamping(const DampingOperator& damping, const char* type)
    : damping_(damping), matrix_(damping.mesh(), damping.elastic(), type, [&](const ElasticBlock& block) {
        return block.damped() || damping.elastic().consistent_mass() != nullptr ||
               damping.strains() != nullptr;
      }) {
  matrix_.declare_positive_definite(true);
  for (int column = 0; column < 3; ++column) projectors_.emplace_back(damping.mesh());
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

/// Of the P of a local node.
double AssembledDamping::projector(LocalIndex node, std::size_t i, std::size_t j) const {
  return projectors_[j].local()[3 * static_cast<std::size_t>(node) + i];
}

/// K_ab ← P_a K_ab P_b for every pair of the cell's nodes.
void AssembledDamping::project_cell(const CellNodes& nodes) {
  const auto n = nodes.size();
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      const auto entry = [&](std::size_t i, std::size_t j) -> double& {
        return cell_[(3 * a + i) * 3 * n + 3 * b + j];
      };
      Mat3d kp{};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          for (std::size_t k = 0; k < 3; ++k) kp(i, j) += entry(i, k) * projector(nodes[b], k, j);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
          entry(i, j) = 0;
          for (std::size_t k = 0; k < 3; ++k) entry(i, j) += projector(nodes[a], i, k) * kp(k, j);
        }
    }
}

void AssembledDamping::assemble() {
  share_projectors();
  matrix_.begin();
  for (const auto& block : damping_.elastic().blocks()) {
    if (block == nullptr || !block->damped()) continue;
    for (LocalIndex cell = 0; cell < block->cells(); ++cell) {
      const auto nodes = block->cell_nodes(cell);
      cell_.resize(9 * nodes.size() * nodes.size());
      block->damping_matrix(cell, cell_);
      for (auto& entry : cell_) entry *= damping_.factor();
      project_cell(nodes);
      matrix_.add(nodes, cell_);
    }
  }
  if (damping_.strains() != nullptr) add_strains();
  if (damping_.elastic().consistent_mass() != nullptr)
    add_consistent_masses();
  else
    add_lumped_masses();
  matrix_.end();
}

/// θΔt² w j jᵀ of every row.
void AssembledDamping::add_strains() {
  const auto& rows = damping_.strains()->rows();
  CellNodes nodes(4);
  cell_.resize(144);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::ranges::copy(rows.nodes()[r], &nodes[0]);
    const auto& j = rows.coefficients()[r];
    for (std::size_t k = 0; k < 144; ++k)
      cell_[k] = j[k / 36][k / 12 % 3] * j[k % 12 / 3][k % 3] / rows.compliances()[r];
    project_cell(nodes);
    matrix_.add(nodes, cell_);
  }
}

void AssembledDamping::add_lumped_masses() {
  const auto mass = damping_.elastic().masses();
  const auto mass_damping = damping_.elastic().mass_damping();
  auto block = unit_block;
  for (std::size_t node = 0; node < mass.size(); ++node) {
    const double damped = mass_damping.empty() ? 0.0 : damping_.factor() * mass_damping[node];
    for (std::size_t k = 0; k < 9; ++k)  // P is symmetric: its order is of no matter
      block[k] = mass[node] * unit_block[k] + damped * projectors_[k / 3].owned()[3 * node + k % 3];
    matrix_.add_diagonal(static_cast<LocalIndex>(node), block);
  }
}

/// P_a (M_ab + s C_ab) P_b of mass and its damping, and D (I − P) for what is held.
void AssembledDamping::add_consistent_masses() {
  const auto& mass = *damping_.elastic().consistent_mass();
  std::array<double, 9> block{};
  const auto add = [&](const ConsistentMass& matrix, double factor) {
    matrix.for_each_entry([&](LocalIndex row, LocalIndex column, double value) {
      for (std::size_t k = 0; k < 9; ++k) {
        block[k] = 0;
        for (std::size_t l = 0; l < 3; ++l)
          block[k] += factor * value * projector(row, k / 3, l) * projector(column, l, k % 3);
      }
      matrix_.add_block(row, column, block);
    });
  };
  add(mass, 1);
  if (const auto* damping = damping_.elastic().consistent_mass_damping(); damping != nullptr)
    add(*damping, damping_.factor());
  for (const auto& c : damping_.constraints()) {
    const double held = mass.diagonal()[static_cast<std::size_t>(c.node)];
    for (std::size_t k = 0; k < 9; ++k) block[k] = held * (unit_block[k] - c.free(k / 3, k % 3));
    matrix_.add_diagonal(c.node, block);
  }
}

}  // namespace evert
