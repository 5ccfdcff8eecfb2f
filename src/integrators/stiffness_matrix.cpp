#include "evert/integrators/stiffness_matrix.hpp"

#include "evert/core/log.hpp"

#include <algorithm>
#include <array>

namespace evert {
namespace {

void update_ghosts(const Halo& halo, NodeField& field) {
  field.touched();
  halo.begin_update(field);
  halo.end_update(field);
}

}  // namespace

StiffnessMatrix::StiffnessMatrix(const DistributedMesh& mesh, const ElasticForces& elastic, const char* type)
    : mesh_(mesh),
      elastic_(elastic),
      matrix_(mesh, elastic, type, [](const ElasticBlock& /*block*/) { return true; }),
      free_(mesh),
      ways_(mesh) {
  hold({});
}

void StiffnessMatrix::hold(std::span<const NodeConstraint> constraints) {
  auto free = free_.owned();
  auto ways = ways_.owned();
  std::fill(free.begin(), free.end(), 1.0);
  std::fill(ways.begin(), ways.end(), 0.0);
  for (const auto& c : constraints)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = 3 * static_cast<std::size_t>(c.node) + k;
      free[i] = c.free(k, k) > 0.5 ? 1 : 0;  // a node of several groups has rounding
      ways[i] = c.prescribed[k];
    }
  update_ghosts(elastic_.halo(), free_);
  update_ghosts(elastic_.halo(), ways_);
}

void StiffnessMatrix::assemble(NodeField& x, TangentForm form, double inertia) {
  fill(x, form, inertia, nullptr);
}

void StiffnessMatrix::assemble(NodeField& x, TangentForm form, double inertia, NodeField& pull) {
  std::fill(pull.local().begin(), pull.local().end(), 0.0);
  fill(x, form, inertia, &pull);
  elastic_.halo().begin_add(pull);
  elastic_.halo().end_add(pull);
  for (std::size_t i = 0; i < pull.owned().size(); ++i) pull.owned()[i] *= free_.owned()[i];
  pull.touched();
}

void StiffnessMatrix::fill(NodeField& x, TangentForm form, double inertia, NodeField* pull) {
  const PhaseScope scope(Phase::assembly);
  update_ghosts(elastic_.halo(), x);
  matrix_.declare_positive_definite(form == TangentForm::projected);
  matrix_.begin();
  for (const auto& block : elastic_.blocks()) {
    if (block == nullptr) continue;
    block->stiffness_matrices(x.local().data(), form, [&](LocalIndex cell, std::span<const double> matrix) {
      const auto nodes = block->cell_nodes(cell);
      if (pull != nullptr) add_pull(nodes, matrix, pull->local());
      cell_.assign(matrix.begin(), matrix.end());
      mask(nodes, cell_);
      matrix_.add(nodes, cell_);
    });
  }
  const auto mass = elastic_.masses();
  std::array<double, 9> block{};
  for (std::size_t node = 0; node < mass.size(); ++node) {
    for (std::size_t k = 0; k < 9; k += 4) block[k] = inertia * mass[node];
    matrix_.add_diagonal(static_cast<LocalIndex>(node), block);
  }
  matrix_.end();
}

void StiffnessMatrix::add_pull(const CellNodes& nodes, std::span<const double> matrix,
                               std::span<double> pull) const {
  const auto ways = ways_.local();
  const auto n = 3 * nodes.size();
  const auto at = [&](std::size_t i) { return 3 * static_cast<std::size_t>(nodes[i / 3]) + i % 3; };
  for (std::size_t j = 0; j < n; ++j) {
    const double way = ways[at(j)];
    if (way == 0) continue;
    for (std::size_t i = 0; i < n; ++i) pull[at(i)] += matrix[i * n + j] * way;
  }
}

/// The diagonal of held components stays, so that it is of the size of its neighbours.
void StiffnessMatrix::mask(const CellNodes& nodes, std::span<double> matrix) const {
  const auto free = free_.local();
  const auto n = 3 * nodes.size();
  for (std::size_t a = 0; a < n; ++a) {
    if (free[3 * static_cast<std::size_t>(nodes[a / 3]) + a % 3] > 0) continue;
    for (std::size_t b = 0; b < n; ++b)
      if (b != a) matrix[a * n + b] = matrix[b * n + a] = 0;
  }
}

}  // namespace evert
