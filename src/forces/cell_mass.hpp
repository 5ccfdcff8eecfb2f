#pragma once
#include "evert/core/index.hpp"
#include "evert/elements/shape_functions.hpp"

#include <array>
#include <span>
#include <vector>

namespace evert {

/// ∫ N_a N_b dX [m^3] of the cells of one type, one after the other.
class CellMass {
 public:
  explicit CellMass(CellType type);

  /// Works the matrix of a cell out. False, and no matrix, where |∂X/∂ξ| is not positive at all points.
  bool compute(std::span<const LocalIndex> cell, std::span<const Vec3d> rest_positions);

  [[nodiscard]] double operator()(std::size_t a, std::size_t b) const { return matrix_[a * nodes() + b]; }
  [[nodiscard]] std::size_t nodes() const { return rule_.nodes; }
  /// |∂X/∂ξ| is the same all over the last cell, to rounding: its matrix is a multiple of one for all such.
  [[nodiscard]] bool uniform() const { return uniform_; }

 private:
  ShapeQuadrature rule_;
  std::array<double, most_nodes * most_nodes> reference_{};  // of |∂X/∂ξ| = 1
  std::array<double, most_nodes * most_nodes> matrix_{};
  std::vector<double> jacobians_;  // determinants at the points
  bool uniform_ = false;
};

}  // namespace evert
