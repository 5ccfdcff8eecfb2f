#pragma once
#include "evert/materials/lame.hpp"
#include "evert/materials/pair_moduli.hpp"
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

#include <algorithm>

/// How stiff an isotropic material is at a point, against its own stiffness at rest.  PHYSICS 5 and 9
///
/// In the frames of U and V, ∂P/∂F falls into ∂²ψ/∂σ² on the diagonal, per pair of axes (P_i − P_j)/(σ_i −
/// σ_j) on the symmetric off-diagonal part, and k = (P_i + P_j)/(σ_i + σ_j) on the skew part, which is what
/// stress adds against rotation. It is compared with B = 2μ I + λ R⊗R, R = U Vᵀ, whose element stiffness
/// K_B,e has a largest eigenvalue λ_e that does not depend on R and so is computed once, at rest; for a
/// linear tetrahedron with λ ≥ 0 it is that of the element at rest itself.
///
///   stretching: the smallest s with the symmetric part ⪯ s B, hence K_sym ⪯ s K_B,e
///   spin:       λmax(K_skew) ≤ k Σ V|∇u|² / u·Mu ≤ k/(2μ + λ) λ_e, since a field u = a φ along its own
///   gradient
///               has ‖∇u‖² = (div u)². Several points have several gradients: of the axes a one has a third
///               of the sum, and 2μ + λ/3 stands in place of 2μ + λ.
///   total:      λmax(K) / λ_e ≤ stretching + spin, and ≤ max(stretching, k/2μ) since ∂P/∂F ⪯ that B
///
/// All are rigorous for one point; several with different R make them an estimate.
namespace evert::kernels {

/// In units of λ_e where not said otherwise; ≥ 0: directions in which the tangent is negative need no small
/// step.
template <class T>
struct TangentBound {
  T stretching;  ///< the symmetric part, which damping sees
  T spin;        ///< the skew part, which it does not
  T total;
  T skew;  ///< the modulus k of the skew part, in units of 2μ
};

/// Of the square of a spread: its third inverse root must stay finite.
template <class Scalar>
inline constexpr Scalar smallest_spread = Scalar(1e-60);
template <>
inline constexpr float smallest_spread<float> = 1e-24F;

/// An upper bound of the largest eigenvalue of a symmetric matrix, exact where the other two are equal and at
/// most 2 % above otherwise (relative to the spread): mean + 2 deviations, then Newton on the characteristic
/// polynomial, which comes down to the largest root from above.
template <Real T>
EVERT_ALWAYS_INLINE T largest_eigenvalue_bound(const Mat3<T>& a) {
  const T mean = T(1.0 / 3) * trace(a);
  const Mat3<T> deviator = a - mean * identity<T>();
  const T spread = sqrt(max(T(1.0 / 6) * contract(deviator, deviator), T(smallest_spread<scalar_t<T>>)));
  // Roots of x³ − 3x − 2g, g = det(deviator) / (2 spread³), lie in [−2, 2].
  const T unit = T(1.0) / spread;
  const T g = T(0.5) * determinant(deviator) * (unit * unit * unit);
  T x = T(2.0);
  for (int step = 0; step < 3; ++step) {
    x -= (x * (x * x - T(3.0)) - (g + g)) / max(T(3.0) * (x * x - T(1.0)), T(1e-3));
  }
  return mean + spread * min(max(x, T(1.0)), T(2.0));
}

/// B^−½ D B^−½ for the diagonal part: B = 2μ I + λ 11ᵀ there.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> relative_to_rest(const Mat3<T>& d, const Lame& lame) {
  const double shear = 1 / std::sqrt(2 * lame.mu);
  const double bulk = 1 / std::sqrt(2 * lame.mu + 3 * lame.lambda);
  const T a = T(shear);
  const T b = T((bulk - shear) / 3);
  const Vec3<T> row_sum = d * Vec3<T>{T(1.0), T(1.0), T(1.0)};
  const T sum = row_sum[0] + row_sum[1] + row_sum[2];
  Mat3<T> relative;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      relative(i, j) = a * a * d(i, j) + a * b * (row_sum[i] + row_sum[j]) + b * b * sum;
    }
  }
  return relative;
}

/// The inverted axis may switch where σ_i + σ_j = 0: the stress jumps there, and no step resolves it. The
/// skew stiffness is not followed any closer.
inline constexpr double smallest_stretch_sum = 0.2;

/// Stands for the stiffness of a state that is not finite: it shrinks the step to nothing.
template <class Scalar>
inline constexpr Scalar unresolvable = Scalar(1e200);
template <>
inline constexpr float unresolvable<float> = 1e30F;

/// The largest eigenvalue of a skew part of modulus 2μ, at most, in units of λ_e.
inline double spin_share(const Lame& lame, int points) {
  const double along_gradient = std::max(lame.lambda, 0.0) / (points == 1 ? 1 : 3);
  return 2 * lame.mu / (2 * lame.mu + along_gradient);
}

/// `model` at the principal stretches `sigma`, in any order, in an element of `points` quadrature points.
/// `model.lame.regular()` must be positive definite; it is what B is made of.
template <Real T, class Model>
EVERT_ALWAYS_INLINE TangentBound<T> tangent_bound(const Model& model, const Vec3<T>& sigma, int points) {
  const Lame lame = model.lame.regular();
  const Vec3<T> stress = model.principal_stress(sigma);
  const Mat3<T> derivative = model.stress_derivative(sigma);
  T stretching = max(largest_eigenvalue_bound(relative_to_rest(derivative, lame)), T(0.0));
  T skew = T(0.0);
  const T in_shear = T(1 / (2 * lame.mu));
  const Vec3<T> shear = shear_moduli(model, sigma, stress, derivative);
  const Vec3<T> spins = spin_moduli(model, sigma, stress, smallest_stretch_sum);
  for (std::size_t k = 0; k < 3; ++k) {
    stretching = max(stretching, in_shear * shear[k]);
    skew = max(skew, in_shear * spins[k]);
  }
  const T spin = T(spin_share(lame, points)) * skew;
  const T total = min(max(stretching, skew), stretching + spin);
  const auto finite = total + T(0.0) * (sigma[0] + sigma[1] + sigma[2]) < T(unresolvable<scalar_t<T>>);
  return {stretching, spin, select(finite, total, T(unresolvable<scalar_t<T>>)), skew};
}

}  // namespace evert::kernels
