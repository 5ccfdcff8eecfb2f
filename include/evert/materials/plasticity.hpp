#pragma once
#include "evert/materials/lame.hpp"
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evert {

/// Permanent deformation of any isotropic material: F = F_e F_p, of which F_e alone has stress and energy.
/// ψ = ψ(F_e) is per volume of the body as it was made, whatever det F_p: P = ∂ψ/∂F = P_e(F_e) F_p⁻ᵀ.
/// paper A, section 6.3; PHYSICS 6
///
/// Flow begins where the norm of the elastic log strain exceeds γ = yield + hardening α, α being the length
/// of the way that log F_p has gone: of all of the strain, or, `isochoric`, of its deviator, which is von
/// Mises' criterion in log strains and keeps det F_p = 1. For small elastic strains that is a yield stress of
/// √6 μ γ in tension, and a hardening modulus of 3 μ `hardening`.
struct Plasticity {
  double yield = std::numeric_limits<double>::infinity();  ///< [-] > 0
  double hardening = 0;                                    ///< [-] ≥ 0
  bool isochoric = true;
  double relaxation_time = 0;  ///< [s] dα/dt is the excess over it; 0: the excess is gone at once
  double limit = 4;            ///< [-] > 1: the principal stretches of F_p stay within 1/limit and limit

  /// γ of a yield stress [Pa] at a shear modulus μ [Pa].
  [[nodiscard]] static double yield_of_stress(double stress, double mu) {
    return stress / (std::sqrt(6.0) * mu);
  }
  /// Hardening of a modulus [Pa] of stress over plastic strain, both in tension.
  [[nodiscard]] static double hardening_of_modulus(double modulus, double mu) { return modulus / (3 * mu); }
  /// α as plastic strain in tension: √(2/3) α.
  [[nodiscard]] static double equivalent_strain(double alpha) { return std::sqrt(2.0 / 3) * alpha; }
};

/// Makes flow go towards a given F_p, and by itself where nothing yields.  paper A, section 7
struct PlasticControl {
  double strength =
      0;            ///< [1/s] rate at which log F_p approaches its goal by itself; 0: only what yields flows
  double from = 0;  ///< [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s]; before and afterwards flow is free
};

/// The largest eigenvalue of an element at rest grows at most by this factor when log F_p goes a way of this
/// length: with F_p⁻¹ then F_p⁻¹ (I + E), ‖E‖ ≤ s = e^way − 1, a gradient G becomes G (I + E), and 2μ‖G‖² +
/// λ(tr G)² at most (1 + s)² (1 + sλ/2μ) times as large.
[[nodiscard]] inline double stiffness_growth(double way, const Lame& lame) {
  const double s = std::expm1(way);
  return (1 + s) * (1 + s) * (1 + s * std::max(lame.lambda, 0.0) / (2 * lame.mu));
}

/// What flows from F_e into F_p in one step.
template <class T>
struct PlasticFlow {
  Vec3<T> log_growth;  ///< by what the principal log strains of F_e become less
  T amount;            ///< its norm, Δα; 0 where nothing flows
};

/// States that are flatter, or inverted, do not flow: no log strain is theirs.
inline constexpr double flattest_flow = 1e-6;

/// Where a trial state returns to: along the ray from it to the origin of log strains, or of their deviators,
/// which is the nearest point of the yield surface. `sigma` are the principal stretches of F_e, in any order,
/// `alpha` is that of before, `dt` the time that has passed [s].
///
/// An excess of the order of rounding does not flow: what has returned rests there, bit by bit.
template <Real T>
EVERT_ALWAYS_INLINE PlasticFlow<T> plastic_flow(const Plasticity& law, const Vec3<T>& sigma, const T& alpha,
                                                double dt) {
  constexpr double rounding = 1e-14;
  const T floor = T(flattest_flow);
  const Vec3<T> strain{log(max(sigma[0], floor)), log(max(sigma[1], floor)), log(max(sigma[2], floor))};
  const T mean = law.isochoric ? T(1.0 / 3) * (strain[0] + strain[1] + strain[2]) : T(0.0);
  const Vec3<T> measured{strain[0] - mean, strain[1] - mean, strain[2] - mean};
  const T length = sqrt(dot(measured, measured));
  const T yield = T(law.yield) + T(law.hardening) * alpha;
  const T excess = length - yield;
  // Backward Euler of dα/dt = excess/relaxation_time.
  const double share = law.relaxation_time > 0 ? dt / (law.relaxation_time + (1 + law.hardening) * dt)
                                               : 1 / (1 + law.hardening);
  const auto flows = excess > T(rounding) && min(min(sigma[0], sigma[1]), sigma[2]) > floor;
  const T amount = select(flows, T(share) * excess, T(0.0));
  return {(amount / max(length, T(rounding))) * measured, amount};
}

}  // namespace evert
