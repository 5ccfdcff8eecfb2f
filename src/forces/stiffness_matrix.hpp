#pragma once
#include "evert/forces/elastic_block.hpp"
#include "evert/materials/fibres.hpp"
#include "evert/materials/tangent.hpp"
#include "evert/math/svd3.hpp"

#include "rest_point.hpp"
#include <algorithm>
#include <array>
#include <span>

/// The stiffness matrix of a cell, point by point, for implicit solvers.
namespace evert {

inline NodeVectors nodal_values(const double* field, const CellNodes& cell) {
  NodeVectors values{};
  for (std::size_t a = 0; a < cell.size(); ++a) {
    const double* at = field + 3 * static_cast<std::ptrdiff_t>(cell[a]);
    values[a] = {at[0], at[1], at[2]};
  }
  return values;
}

/// Σ_jl ∂P̂_ij/∂F̂_kl a_j b_l: rows i, columns k. The tangent couples an entry of F̂ off the diagonal with
/// itself and its mirror image only, so most of the 81 terms are zero.
inline Mat3d between_gradients(const PrincipalTangent<double>& tangent, const Vec3d& a, const Vec3d& b) {
  Mat3d block;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) block(i, k) = tangent.stretch(i, k) * a[i] * b[k];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const double same = 0.5 * (tangent.shear[k] + tangent.spin[k]);
    const double mirrored = 0.5 * (tangent.shear[k] - tangent.spin[k]);
    block(i, i) += same * a[j] * b[j];
    block(j, j) += same * a[i] * b[i];
    block(i, j) += mirrored * a[j] * b[i];
    block(j, i) += mirrored * a[i] * b[j];
  }
  return block;
}

/// ∂P/∂F of one point between any two of its shape gradients: rows and columns are components of nodes.
template <class Model>
class PointTangent {
 public:
  /// `fibre`: the direction at rest, turned as the cell is; of models with fibres.
  PointTangent(const Model& model, const Mat3d& deformation_gradient, const Vec3d& fibre,
               std::span<const Vec3d> gradients, TangentForm form)
      : svd_(svd3(deformation_gradient)), tangent_(matrix_tangent(model, svd_.sigma)) {
    if (form == TangentForm::projected) tangent_ = positive_part(tangent_);
    for (std::size_t a = 0; a < gradients.size(); ++a) turned_[a] = transpose_times(svd_.v, gradients[a]);
    if constexpr (HasFibres<Model>) {
      for (std::size_t a = 0; a < gradients.size(); ++a) along_fibre_[a] = dot(fibre, gradients[a]);
      of_fibre_ = fibre_tangent(model, deformation_gradient * fibre, form);
    }
  }

  [[nodiscard]] Mat3d between(std::size_t a, std::size_t b) const {
    Mat3d block = svd_.u * times_transpose(between_gradients(tangent_, turned_[a], turned_[b]), svd_.u);
    if constexpr (HasFibres<Model>) block += (along_fibre_[a] * along_fibre_[b]) * of_fibre_;
    return block;
  }

 private:
  static PrincipalTangent<double> matrix_tangent(const Model& model, const Vec3d& sigma) {
    if constexpr (HasFibres<Model>)
      return principal_tangent(model.matrix(), sigma);
    else
      return principal_tangent(model, sigma);
  }

  /// Of (T/Λ) F a aᵀ with respect to `now` = F a: T' along the fibre, T/Λ across.
  static Mat3d fibre_tangent(const Model& model, const Vec3d& now, TangentForm form) {
    const double stretch = std::max(norm(now), 1e-30);
    const Vec3d direction = (1 / stretch) * now;
    const double across = fibre_pull(model, stretch);
    double along = model.fibre_stiffness(stretch);
    if (form == TangentForm::projected) along = std::max(along, 0.0);
    return across * identity<double>() + (along - across) * outer(direction, direction);
  }

  Svd3<double> svd_;
  PrincipalTangent<double> tangent_;
  NodeVectors turned_{};                          // Vᵀ ∂N_a/∂X
  std::array<double, most_nodes> along_fibre_{};  // a · ∂N_a/∂X
  Mat3d of_fibre_{};
};

/// Adds |∂X/∂ξ| W ∂P/∂F of one point, between the shape gradients of all `nodes` at `x`, to the cell's
/// `matrix`, row-major 3n×3n.
template <class Model>
void add_stiffness(const RestPoint& point, std::size_t nodes, const NodeVectors& x, const Vec3d& fibre,
                   const Model& model, TangentForm form, std::span<double> matrix) {
  Mat3d f{};
  for (std::size_t a = 1; a < nodes; ++a) f += outer(x[a] - x[0], point.gradients[a]);
  const PointTangent<Model> tangent(model, f, fibre, std::span(point.gradients).first(nodes), form);
  for (std::size_t a = 0; a < nodes; ++a)
    for (std::size_t b = a; b < nodes; ++b) {
      const Mat3d block = point.volume * tangent.between(a, b);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          matrix[(3 * a + i) * 3 * nodes + 3 * b + k] += block(i, k);
          if (b != a) matrix[(3 * b + k) * 3 * nodes + 3 * a + i] += block(i, k);
        }
    }
}

}  // namespace evert
