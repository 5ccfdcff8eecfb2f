#pragma once
#include "evert/materials/fibre_curves.hpp"
#include "evert/materials/fibres.hpp"
#include "evert/materials/mooney_rivlin.hpp"

#include <string_view>

namespace evert {

/// Skeletal muscle: a Mooney-Rivlin matrix, with its continuation below the compression limit, and fibres of
/// tension T(Λ) = σ0 (α f_active(Λ) + f_passive(Λ)) per area at rest, α the activation.  PHYSICS 3 and 10;
/// Teran et al. 2005 (paper A, [44])
///
/// At a given activation the stress is the gradient of an energy. A change of activation changes that energy:
/// this is the work that a muscle does. Active muscle is not free of stress at rest.
struct Muscle {
  static constexpr std::string_view name = "muscle";
  static constexpr double default_compression_limit = 0.25;
  static constexpr double default_peak_stress = 3e5;  ///< [Pa]

  Lame lame{};  ///< of the matrix, which all of the model is for small strains without activation
  double share_01 = MooneyRivlin::default_share_01;      ///< μ01/(μ10 + μ01) in [0, 1]
  double compression_limit = default_compression_limit;  ///< in (0, 1)
  double peak_stress = default_peak_stress;              ///< σ0 ≥ 0 [Pa]
  PassiveCurve passive{};
  ActiveCurve active{};
  double activation = 0;  ///< α in [0, 1]

  EVERT_ALWAYS_INLINE MooneyRivlin matrix() const { return {lame, share_01, compression_limit}; }

  /// ψ_fibre [Pa], 0 at stretch 1.
  template <class T>
  EVERT_ALWAYS_INLINE T fibre_energy(const T& stretch) const {
    return T(peak_stress) * (T(activation) * active.energy(stretch) + passive.energy(stretch));
  }
  /// T = dψ_fibre/dΛ ≥ 0 [Pa].
  template <class T>
  EVERT_ALWAYS_INLINE T fibre_tension(const T& stretch) const {
    return T(peak_stress) * (T(activation) * active.tension(stretch) + passive.tension(stretch));
  }
  /// dT/dΛ [Pa]; negative where active muscle is stretched.
  template <class T>
  EVERT_ALWAYS_INLINE T fibre_stiffness(const T& stretch) const {
    return T(peak_stress) * (T(activation) * active.stiffness(stretch) + passive.stiffness(stretch));
  }

  template <class T>
  EVERT_ALWAYS_INLINE AlongFibre<Muscle, T> along(const Vec3<T>& direction) const {
    return {*this, direction};
  }
};

}  // namespace evert
