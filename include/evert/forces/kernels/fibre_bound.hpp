#pragma once
#include "evert/forces/kernels/tangent_bound.hpp"
#include "evert/materials/fibres.hpp"

/// How stiff a material with fibres is at a point: what its fibres add to the bounds of tangent_bound.hpp.
///
/// A change D = Uᵀ dF V of the deformation meets, with b = Vᵀa, n = F̂b/Λ the direction of the fibre now, the
/// slope h = dT/dΛ and the pull t = T/Λ,
///
///   q(D) = h (n·Db)² + t |Db − n (n·Db)|²
///
/// (h < 0, active fibres that are stretched, counts as 0.) With D = S + W, symmetric and skew, c = n·b and s
/// = √(1 − c²), and for every e > 0 (x + y)² ≤ (1 + e) x² + (1 + 1/e) y²; here e = s for the first and 1 for
/// the second part. With (n·Sb)² ≤ ½(1 + c²) ‖S‖², (n·Wb)² ≤ ½s² ‖W‖², |Wb|² ≤ ½‖W‖²
///
///   q ≤ [½h (1 + s)(1 + c²) + 2t] ‖S‖² + [½h (s + s²) + t] ‖W‖²
///
/// and B is at least min(2μ, 2μ + 3λ) ‖S‖² on symmetric ones.
///
/// Also q ≤ k |Db|², k = max(h, t), and λmax of Σ V |∇u a|² against uMu is at most λ_e/(2μ + λ): it is
/// reached by fields u = φ a, whose B is Σ V (2μ |∇φ|² + λ (a·∇φ)²) ≥ (2μ + λ) Σ V (a·∇φ)². Hence the total
/// is at most that of the matrix + k/(2μ + λ).
namespace evert::kernels {

/// Moduli of q [Pa], all ≥ 0.
template <class T>
struct FibreModuli {
  T stretching;  ///< of ‖S‖²
  T skew;        ///< of ‖W‖²
  T all;         ///< of |Db|²
};

template <Real T, class Model>
EVERT_ALWAYS_INLINE FibreModuli<T> fibre_moduli(const AlongFibre<Model, T>& along, const Svd3<T>& svd) {
  const Vec3<T> b = along.in_frame(svd);
  const Vec3<T> now = along.stretched(svd.sigma, b);
  const T length = sqrt(dot(now, now));
  const T inverse = T(1.0) / max(length, T(1e-30));
  const T pull = inverse * along.model.fibre_tension(length);
  const T slope = max(along.model.fibre_stiffness(length), T(0.0));
  const T cosine = inverse * dot(now, b);
  const T square = cosine * cosine;
  const T sine = sqrt(max(T(1.0) - square, T(0.0)));
  return {T(0.5) * slope * (T(1.0) + sine) * (T(1.0) + square) + T(2.0) * pull,
          T(0.5) * slope * (sine + sine * sine) + pull, max(slope, pull)};
}

/// A model along its fibres, with `svd` that of F, in an element of `points` quadrature points.
template <Real T, class Model>
EVERT_ALWAYS_INLINE TangentBound<T> tangent_bound(const AlongFibre<Model, T>& along, const Svd3<T>& svd,
                                                  int points) {
  const Lame lame = along.model.lame.regular();
  const TangentBound<T> matrix = tangent_bound(along.model.matrix(), svd.sigma, points);
  const FibreModuli<T> fibre = fibre_moduli(along, svd);
  const double least = 2 * lame.mu + std::min(0.0, 3 * lame.lambda);
  const T stretching = matrix.stretching + T(1 / least) * fibre.stretching;
  const T skew = matrix.skew + T(1 / (2 * lame.mu)) * fibre.skew;
  const T spin = T(spin_share(lame, points)) * skew;
  const T apart = matrix.total + T(1 / (2 * lame.mu + lame.lambda)) * fibre.all;
  const T total = min(min(max(stretching, skew), stretching + spin), apart);
  const T limit = T(unresolvable<scalar_t<T>>);
  return {stretching, spin, select(matrix.total < limit, select(total < limit, total, limit), limit), skew};
}

}  // namespace evert::kernels
