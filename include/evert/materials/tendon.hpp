#pragma once
#include "evert/materials/fibre_curves.hpp"
#include "evert/materials/fibres.hpp"
#include "evert/materials/mooney_rivlin.hpp"

#include <string_view>

namespace evert {

/// Tendon: muscle (muscle.hpp) without the active part of its fibres.  PHYSICS 3
struct Tendon {
  static constexpr std::string_view name = "tendon";
  static constexpr double default_compression_limit = 0.25;
  static constexpr double default_peak_stress = 3e5;  ///< [Pa]

  Lame lame{};                                           ///< of the matrix
  double share_01 = MooneyRivlin::default_share_01;      ///< μ01/(μ10 + μ01) in [0, 1]
  double compression_limit = default_compression_limit;  ///< in (0, 1)
  double peak_stress = default_peak_stress;              ///< σ0 ≥ 0, the unit of the curve [Pa]
  PassiveCurve passive{};

  EVERT_ALWAYS_INLINE MooneyRivlin matrix() const { return {lame, share_01, compression_limit}; }

  /// ψ_fibre [Pa], 0 at stretch 1.
  template <class T>
  EVERT_ALWAYS_INLINE T fibre_energy(const T& stretch) const {
    return T(peak_stress) * passive.energy(stretch);
  }
  /// T = dψ_fibre/dΛ ≥ 0 [Pa].
  template <class T>
  EVERT_ALWAYS_INLINE T fibre_tension(const T& stretch) const {
    return T(peak_stress) * passive.tension(stretch);
  }
  /// dT/dΛ ≥ 0 [Pa].
  template <class T>
  EVERT_ALWAYS_INLINE T fibre_stiffness(const T& stretch) const {
    return T(peak_stress) * passive.stiffness(stretch);
  }

  template <class T>
  EVERT_ALWAYS_INLINE AlongFibre<Tendon, T> along(const Vec3<T>& direction) const {
    return {*this, direction};
  }
};

}  // namespace evert
