#include "spare_mass.hpp"

namespace evert {
namespace {

/// ‖K_e,aa‖: the largest eigenvalue of V (μ|g|² I + (λ + μ) g gᵀ).
double stiffness_at(const FilterCell& cell, std::size_t a) {
  const Vec3d& g = cell.shape.gradients[a];
  return cell.shape.volume * (cell.lame.lambda + 2 * cell.lame.mu) * dot(g, g);
}

}  // namespace

double own_eigenvalue(const FilterCell& cell) {
  return element_modes(cell.shape, cell.own_masses(), cell.lame).largest();
}

SpareMass::SpareMass(const FilterProblem& problem, std::span<const double> own, double limit)
    : problem_(problem), own_(own), limit_(limit), sums_(problem) {
  for (std::size_t c = 0; c < problem.cells.size(); ++c) {
    const auto& cell = problem.cells[c];
    const auto masses = cell.own_masses();
    for (std::size_t a = 0; a < 4; ++a) {
      if (own[c] > limit)
        sums_.at(cell.nodes[a], 1) += stiffness_at(cell, a);
      else
        sums_.at(cell.nodes[a], 0) += own[c] / limit * masses[a];
    }
  }
  sums_.share();
}

CellClamp SpareMass::clamp(std::size_t c) const {
  if (!(own_[c] > limit_)) return {};
  const auto& cell = problem_.cells[c];
  TetMasses shares{};
  for (std::size_t a = 0; a < 4; ++a) {
    const auto node = cell.nodes[a];
    const double spare = problem_.masses[static_cast<std::size_t>(node)] - sums_.at(node, 0);
    shares[a] = spare * stiffness_at(cell, a) / sums_.at(node, 1);
  }
  if (!(element_modes(cell.shape, shares, cell.lame).largest() > limit_)) return {};
  return {shares, limit_};
}

}  // namespace evert
