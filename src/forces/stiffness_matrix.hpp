#pragma once
#include "evert/forces/elastic_block.hpp"
#include "evert/materials/fibres.hpp"
#include "evert/materials/tangent.hpp"
#include "evert/math/nodal.hpp"
#include "evert/math/svd3.hpp"

#include "rest_point.hpp"
#include <algorithm>
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

/// How a point of a cell is deformed.
struct PointState {
  Mat3d deformation_gradient;
  Svd3<double> svd;
  Vec3d fibre;  ///< direction at rest, turned as the cell is; of models with fibres
};

/// ∂P/∂F of one point between two of its shape gradients: rows and columns are components of nodes.
template <class Model>
class PointTangent {
 public:
  PointTangent(const Model& model, const PointState& state, TangentForm form)
      : state_(state), tangent_(matrix_tangent(model, state.svd.sigma)) {
    if (form == TangentForm::projected) tangent_ = positive_part(tangent_);
    if constexpr (HasFibres<Model>) {
      now_ = state.deformation_gradient * state.fibre;
      const double stretch = std::max(norm(now_), 1e-30);
      now_ = (1 / stretch) * now_;
      across_ = model.fibre_tension(stretch) / stretch;
      along_ = model.fibre_stiffness(stretch);
      if (form == TangentForm::projected) along_ = std::max(along_, 0.0);
    }
  }

  [[nodiscard]] Mat3d between(const Vec3d& a, const Vec3d& b) const {
    const Svd3<double>& svd = state_.svd;
    const Mat3d in_frame = between_gradients(tangent_, transpose_times(svd.v, a), transpose_times(svd.v, b));
    Mat3d block = svd.u * times_transpose(in_frame, svd.u);
    if constexpr (HasFibres<Model>) {
      // Of (T/Λ) F a aᵀ: T' along the fibre, T/Λ across.
      const double share = dot(state_.fibre, a) * dot(state_.fibre, b);
      block += share * (across_ * identity<double>() + (along_ - across_) * outer(now_, now_));
    }
    return block;
  }

 private:
  static PrincipalTangent<double> matrix_tangent(const Model& model, const Vec3d& sigma) {
    if constexpr (HasFibres<Model>)
      return principal_tangent(model.matrix(), sigma);
    else
      return principal_tangent(model, sigma);
  }

  const PointState& state_;
  PrincipalTangent<double> tangent_;
  Vec3d now_{};  // the direction of the fibre
  double along_ = 0, across_ = 0;
};

/// Adds |∂X/∂ξ| W ∂P/∂F of one point, between the shape gradients of all `nodes` at `x`, to the cell's
/// `matrix`, row-major 3n×3n.
template <class Model>
void add_stiffness(const RestPoint& point, std::size_t nodes, const NodeVectors& x, const Vec3d& fibre,
                   const Model& model, TangentForm form, std::span<double> matrix) {
  Mat3d f{};
  for (std::size_t a = 1; a < nodes; ++a) f += outer(x[a] - x[0], point.gradients[a]);
  const PointState state{f, svd3(f), fibre};
  const PointTangent<Model> tangent(model, state, form);
  for (std::size_t a = 0; a < nodes; ++a)
    for (std::size_t b = a; b < nodes; ++b) {
      const Mat3d block = point.volume * tangent.between(point.gradients[a], point.gradients[b]);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          matrix[(3 * a + i) * 3 * nodes + 3 * b + k] += block(i, k);
          if (b != a) matrix[(3 * b + k) * 3 * nodes + 3 * a + i] += block(i, k);
        }
    }
}

}  // namespace evert
