#pragma once
#include "evert/forces/elastic_block.hpp"
#include "evert/materials/tangent.hpp"
#include "evert/math/nodal.hpp"
#include "evert/math/svd3.hpp"

#include "rest_point.hpp"
#include <span>

/// The stiffness matrix of a cell, point by point, for implicit solvers.
namespace evert {

template <int nodes>
NodeVectors<nodes> nodal_values(const double* field, const CellNodes& cell) {
  NodeVectors<nodes> values;
  for (std::size_t a = 0; a < nodes; ++a) {
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

/// Adds |∂X/∂ξ| W ∂P/∂F of one point, between the shape gradients of all nodes at `x`, to the cell's
/// `matrix`, row-major 3n×3n. The frame that the gradients of the point are given in does not matter to
/// isotropic models.
template <int nodes, class Model>
void add_stiffness(const RestPoint<nodes>& point, const NodeVectors<nodes>& x, const Model& model,
                   TangentForm form, std::span<double> matrix) {
  Mat3d f{};
  for (std::size_t a = 1; a < nodes; ++a) f += outer(x[a] - x[0], point.gradients[a]);
  const Svd3<double> svd = svd3(f);
  auto tangent = principal_tangent(model, svd.sigma);
  if (form == TangentForm::projected) tangent = positive_part(tangent);
  NodeVectors<nodes> turned;
  for (std::size_t a = 0; a < nodes; ++a) turned[a] = transpose_times(svd.v, point.gradients[a]);
  for (std::size_t a = 0; a < nodes; ++a)
    for (std::size_t b = a; b < nodes; ++b) {
      const auto in_frame = point.volume * between_gradients(tangent, turned[a], turned[b]);
      const auto block = svd.u * times_transpose(in_frame, svd.u);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          matrix[(3 * a + i) * 3 * nodes + 3 * b + k] += block(i, k);
          if (b != a) matrix[(3 * b + k) * 3 * nodes + 3 * a + i] += block(i, k);
        }
    }
}

}  // namespace evert
