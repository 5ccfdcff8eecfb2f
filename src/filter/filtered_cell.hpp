#pragma once
#include "evert/core/index.hpp"
#include "evert/filter/element_modes.hpp"
#include "evert/materials/damping.hpp"
#include "evert/materials/rotated_linear.hpp"
#include "evert/materials/tangent.hpp"
#include "evert/math/nodal.hpp"
#include "evert/math/svd3.hpp"

#include <array>
#include <concepts>
#include <limits>

/// One filtered tetrahedron, evaluated.  PHYSICS 9
///
/// Filtered elements are few: plain numbers, one cell after the other.
namespace evert {

using Svd3d = Svd3<double>;

/// Turned at rest so that its strains stand along the axes of the filter: F is F Q of the world's F, as in
/// elements/shape_layout.hpp.
struct FilteredCell {
  std::array<LocalIndex, 4> nodes{};
  std::array<Vec3d, 4> gradients{};
  double volume = 0;
  StrainFilter filter{};
};

/// Values of a nodal field at the four nodes.
using TetValues = std::array<Vec3d, 4>;

inline TetValues values_of(const FilteredCell& cell, const double* field) {
  TetValues values;
  for (std::size_t a = 0; a < 4; ++a) {
    const double* at = field + 3 * static_cast<std::ptrdiff_t>(cell.nodes[a]);
    values[a] = {at[0], at[1], at[2]};
  }
  return values;
}

/// Differences first, so that a common translation costs no digits.
inline Mat3d gradient_of(const FilteredCell& cell, const TetValues& values) {
  Mat3d sum{};
  for (std::size_t a = 1; a < 4; ++a) sum += outer(values[a] - values[0], cell.gradients[a]);
  return sum;
}

inline Mat3d symmetric_part(const Mat3d& a) { return 0.5 * (a + transpose(a)); }

inline Mat3d rotation_of(const Svd3d& f) { return times_transpose(f.u, f.v); }

/// A (S − I). From σ − 1, which keeps the digits of small strains.
inline Mat3d filtered_strain(const FilteredCell& cell, const Svd3d& f) {
  const Vec3d elongation = f.sigma - Vec3d{1, 1, 1};
  return cell.filter(f.v * times_transpose(diagonal(elongation), f.v));
}

/// A symmetric tensor: `axes` diag(values) axesᵀ, whatever the signs.
struct PrincipalAxes {
  Vec3d values;
  Mat3d axes;
};

/// Of I + `strain`. Shifted until it is positive definite, a symmetric tensor is its own stretch: the SVD is
/// then the eigenvalue decomposition, to the rounding of the largest.
inline PrincipalAxes principal_axes(const Mat3d& strain) {
  const Mat3d stretch = identity<double>() + strain;
  const double shift = 2 * norm(stretch);
  const Svd3d svd = svd3(stretch + shift * identity<double>());
  return {svd.sigma - Vec3d{shift, shift, shift}, svd.v};
}

inline Mat3d tensor_of(const Mat3d& axes, const Vec3d& values) {
  return axes * times_transpose(diagonal(values), axes);
}

/// σ(S̃) of the model at the filtered strain [Pa].
template <class Model>
Mat3d stress_of(const Model& model, const Mat3d& strain) {
  if constexpr (std::same_as<Model, RotatedLinear>) {
    return 2 * model.lame.mu * strain + (model.lame.lambda * trace(strain)) * identity<double>();
  } else {
    const auto [values, axes] = principal_axes(strain);
    return tensor_of(axes, model.principal_stress(values));
  }
}

/// ψ(S̃) [Pa].
template <class Model>
double energy_of(const Model& model, const Mat3d& strain) {
  if constexpr (std::same_as<Model, RotatedLinear>) {
    const double change = trace(strain);
    return model.lame.mu * contract(strain, strain) + 0.5 * model.lame.lambda * change * change;
  } else {
    return model.energy(principal_axes(strain).values);
  }
}

/// x of J x = b for a symmetric positive semidefinite J. Where J is singular (nodes in a line or a point), so
/// is b, and x stays finite.
inline Vec3d solve_semidefinite(const Mat3d& j, const Vec3d& b) {
  const double smallest =
      std::numeric_limits<double>::epsilon() * trace(j) + std::numeric_limits<double>::min();
  const double d0 = max(j(0, 0), smallest);
  const double l10 = j(1, 0) / d0, l20 = j(2, 0) / d0;
  const double d1 = max(j(1, 1) - l10 * j(1, 0), smallest);
  const double rest = j(2, 1) - l20 * j(1, 0);
  const double l21 = rest / d1;
  const double d2 = max(j(2, 2) - l20 * j(2, 0) - l21 * rest, smallest);
  const double y1 = b[1] - l10 * b[0];
  const double y2 = b[2] - l20 * b[0] - l21 * y1;
  const double x2 = y2 / d2;
  const double x1 = y1 / d1 - l21 * x2;
  return {b[0] / d0 - l10 * x1 - l20 * x2, x1, x2};
}

/// Takes the torque off forces whose sum is zero: f_a −= β × r_a with (Σ|r|²I − r rᵀ) β = Σ r × f, r from the
/// centroid of the nodes. That is the smallest change, and none at rest, where the stress has no torque.
inline void remove_torque(const TetValues& x, TetValues& f) {
  TetValues r;
  Vec3d centroid{};
  for (std::size_t a = 1; a < 4; ++a) centroid += 0.25 * (x[a] - x[0]);
  Vec3d torque{};
  Mat3d inertia{};
  for (std::size_t a = 0; a < 4; ++a) {
    r[a] = (x[a] - x[0]) - centroid;
    torque += cross(r[a], f[a]);
    inertia += dot(r[a], r[a]) * identity<double>() - outer(r[a], r[a]);
  }
  const Vec3d beta = solve_semidefinite(inertia, torque);
  f[0] = {0, 0, 0};
  for (std::size_t a = 1; a < 4; ++a) {
    f[a] -= cross(beta, r[a]);
    f[0] -= f[a];
  }
}

/// −V P g_a, without torque. P = R σ'.
inline TetValues balanced_forces(const FilteredCell& cell, const TetValues& x, const Mat3d& stress) {
  TetValues f;
  f[0] = {0, 0, 0};
  for (std::size_t a = 1; a < 4; ++a) {
    f[a] = -cell.volume * (stress * cell.gradients[a]);
    f[0] -= f[a];
  }
  remove_torque(x, f);
  return f;
}

/// What ∂P/∂F a stiffness matrix is made of: R and A outside of ∂σ/∂S̃. R is held, since with its change P has
/// no symmetric tangent; at rest nothing is missing.
class FilteredTangent {
 public:
  template <class Model>
  FilteredTangent(const Model& model, const FilteredCell& cell, const Svd3d& f, bool projected)
      : cell_(cell), rotation_(rotation_of(f)) {
    const auto [values, axes] = principal_axes(filtered_strain(cell, f));
    axes_ = axes;
    tangent_ = principal_tangent(model, values);
    if (projected) tangent_ = positive_part(tangent_);
    tangent_.spin = {0, 0, 0};  // a strain has none
  }

  /// dP of dF.
  [[nodiscard]] Mat3d operator()(const Mat3d& change) const {
    const Mat3d strain = cell_.filter(symmetric_part(transpose_times(rotation_, change)));
    const Mat3d stress = axes_ * times_transpose(tangent_(transpose_times(axes_, strain * axes_)), axes_);
    return rotation_ * cell_.filter.transposed(stress);
  }

 private:
  const FilteredCell& cell_;
  Mat3d rotation_, axes_{};
  PrincipalTangent<double> tangent_{};
};

/// A of the damping models (forces/kernels/damping_kernels.hpp): what strain rates are seen from.
inline Mat3d damping_frame(DampingModel model, const Mat3d& f, const Svd3d& svd) {
  if (model == DampingModel::rotated) return rotation_of(svd);
  if (model == DampingModel::objective) return f;
  const Vec3d to_rotation = rotated_share(svd.sigma) * (Vec3d{1, 1, 1} - svd.sigma);
  return f + svd.u * times_transpose(diagonal(to_rotation), svd.v);
}

/// |∂X/∂ξ| W P of the damping law at the velocity gradient `rate`, filtered on both sides: symmetric and
/// positive semidefinite as the law itself.
inline Mat3d viscous_stress(const FilteredCell& cell, const Damping& damping, const Mat3d& frame,
                            const Mat3d& rate) {
  const Mat3d strain_rate = cell.filter(symmetric_part(transpose_times(frame, rate)));
  const Mat3d stress =
      2 * damping.beta * strain_rate + (damping.alpha * trace(strain_rate)) * identity<double>();
  return cell.volume * (frame * cell.filter.transposed(stress));
}

}  // namespace evert
