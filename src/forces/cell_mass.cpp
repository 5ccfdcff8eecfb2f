#include "cell_mass.hpp"

#include <algorithm>
#include <cmath>

namespace evert {
namespace {

using Matrix = std::array<double, most_nodes * most_nodes>;

/// Σ_q weight(q) N_a N_b.
template <class Weight>
void integrate(const ShapeQuadrature& rule, Matrix& matrix, Weight&& weight) {
  const std::size_t n = rule.nodes;
  matrix.fill(0);
  for (std::size_t q = 0; q < rule.points.size(); ++q) {
    const auto& values = rule.points[q].values;
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b <= a; ++b) matrix[a * n + b] += weight(q) * values[a] * values[b];
  }
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < a; ++b) matrix[b * n + a] = matrix[a * n + b];
}

double jacobian_determinant(const ShapeQuadrature::Point& point, std::span<const LocalIndex> cell,
                            std::span<const Vec3d> rest_positions) {
  Mat3d jacobian{};
  for (std::size_t a = 0; a < cell.size(); ++a)
    jacobian += outer(rest_positions[static_cast<std::size_t>(cell[a])], point.gradients[a]);
  return determinant(jacobian);
}

}  // namespace

CellMass::CellMass(CellType type) : rule_(mass_quadrature(type)), jacobians_(rule_.points.size()) {
  integrate(rule_, reference_, [&](std::size_t q) { return rule_.points[q].weight; });
}

bool CellMass::compute(std::span<const LocalIndex> cell, std::span<const Vec3d> rest_positions) {
  std::transform(rule_.points.begin(), rule_.points.end(), jacobians_.begin(),
                 [&](const auto& point) { return jacobian_determinant(point, cell, rest_positions); });
  const auto [smallest, largest] = std::minmax_element(jacobians_.begin(), jacobians_.end());
  if (!std::ranges::all_of(jacobians_, [](double det) { return std::isnormal(det) && det > 0; }))
    return false;
  constexpr double rounding = 1e-12;
  uniform_ = *largest - *smallest <= rounding * *largest;
  if (uniform_)
    std::ranges::transform(reference_, matrix_.begin(), [&](double of_one) { return *largest * of_one; });
  else
    integrate(rule_, matrix_, [&](std::size_t q) { return rule_.points[q].weight * jacobians_[q]; });
  return true;
}

}  // namespace evert
