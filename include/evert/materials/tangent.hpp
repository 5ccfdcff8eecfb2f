#pragma once
#include "evert/materials/pair_moduli.hpp"
#include "evert/math/eigen_symmetric3.hpp"
#include "evert/math/pack.hpp"
#include "evert/math/svd3.hpp"
#include "evert/math/vec3.hpp"

#include <array>

/// The whole tangent ∂P/∂F of isotropic models, for implicit solvers and for verification.
///
///   const Svd3d svd = svd3(f);
///   const auto tangent = positive_part(principal_tangent(model, svd.sigma));
///   const Mat3d dp = stress_change(tangent, svd, df);
namespace evert {

/// ∂P/∂F in the frames of U and V, where it falls into four: ∂²ψ/∂σ² on the diagonal, and for every pair of
/// axes a modulus each for the symmetric and the skew part off the diagonal. [Pa]
template <class T>
struct PrincipalTangent {
  Mat3<T> stretch;  ///< ∂²ψ/∂σ_i∂σ_j
  Vec3<T> shear;    ///< (P̂_i − P̂_j)/(σ_i − σ_j), k: of the pair without axis k
  Vec3<T> spin;     ///< (P̂_i + P̂_j)/(σ_i + σ_j)

  /// Uᵀ dP V of `change` = Uᵀ dF V.
  EVERT_ALWAYS_INLINE Mat3<T> operator()(const Mat3<T>& change) const {
    const Vec3<T> on = stretch * Vec3<T>{change(0, 0), change(1, 1), change(2, 2)};
    Mat3<T> result = diagonal(on);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const T symmetric = T(0.5) * shear[k] * (change(i, j) + change(j, i));
      const T skew = T(0.5) * spin[k] * (change(i, j) - change(j, i));
      result(i, j) = symmetric + skew;
      result(j, i) = symmetric - skew;
    }
    return result;
  }
};

/// Stretches whose sum is smaller are taken to have this sum, in models that are not smooth there: the
/// inverted axis switches, P jumps, and no tangent is right.
inline constexpr double resolved_stretch_sum = 1e-6;

/// `model` at the stretches of Svd3 or Deflation. Equal, zero and negative stretches included; where the
/// derivative jumps (a compression limit), that of the side above. With `Extension::clamp`, whose stress has
/// no energy, the diagonal part is that at the limited stretches, and no derivative.
template <Real T, class Model>
EVERT_ALWAYS_INLINE PrincipalTangent<T> principal_tangent(const Model& model, const Vec3<T>& sigma) {
  const Vec3<T> stress = model.principal_stress(sigma);
  const Mat3<T> derivative = model.stress_derivative(sigma);
  return {derivative, shear_moduli(model, sigma, stress, derivative),
          spin_moduli(model, sigma, stress, resolved_stretch_sum)};
}

/// The nearest tangent (in the Frobenius norm) that is positive semidefinite: a Newton step on it descends.
[[nodiscard]] inline PrincipalTangent<double> positive_part(const PrincipalTangent<double>& tangent) {
  const auto [values, vectors] = eigen_symmetric3(tangent.stretch);
  PrincipalTangent<double> positive{};
  for (std::size_t k = 0; k < 3; ++k) {
    positive.stretch += max(values[k], 0.0) * outer(vectors.column[k], vectors.column[k]);
    positive.shear[k] = max(tangent.shear[k], 0.0);
    positive.spin[k] = max(tangent.spin[k], 0.0);
  }
  return positive;
}

/// dP of dF, with `svd` that of F.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> stress_change(const PrincipalTangent<T>& tangent, const Svd3<T>& svd,
                                          const Mat3<T>& df) {
  return times_transpose(svd.u * tangent(transpose_times(svd.u, df * svd.v)), svd.v);
}

/// ∂P_ij/∂F_kl in row 3i + j, column 3k + l; symmetric.
template <Real T>
[[nodiscard]] std::array<std::array<T, 9>, 9> tangent_matrix(const PrincipalTangent<T>& tangent,
                                                             const Svd3<T>& svd) {
  std::array<std::array<T, 9>, 9> matrix;
  for (std::size_t column = 0; column < 9; ++column) {
    Mat3<T> df{};
    df(column / 3, column % 3) = T(1.0);
    const Mat3<T> dp = stress_change(tangent, svd, df);
    for (std::size_t row = 0; row < 9; ++row) matrix[row][column] = dp(row / 3, row % 3);
  }
  return matrix;
}

}  // namespace evert
