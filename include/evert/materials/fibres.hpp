#pragma once
#include "evert/materials/stress_measures.hpp"
#include "evert/math/svd3.hpp"

#include <concepts>

/// Models that are isotropic but for fibres along one direction a of the rest shape: ψ = ψ_matrix(σ) +
/// ψ_fibre(Λ), Λ = |F a|.  paper A, section 6.1; PHYSICS 3
namespace evert {

/// T/Λ [Pa] at a stretch Λ: the fibres add (T/Λ) F a aᵀ to P. One that has no length left has no tension
/// either.
template <class Model, class T>
EVERT_ALWAYS_INLINE T fibre_pull(const Model& model, const T& stretch) {
  return model.fibre_tension(stretch) / max(stretch, T(1e-30));
}

/// A model at a point where the unit vector `direction` is that of the fibres at rest. With b = Vᵀa,
///
///   P̂ = diag(P̂_matrix) + F̂ (T/Λ) b bᵀ,  T = dψ_fibre/dΛ
///
/// a diagonal matrix and F̂ times a symmetric one: angular momentum is kept, flat and inverted included.
/// Refers to the model, which must outlive it.
template <class Model, class T>
struct AlongFibre {
  const Model& model;
  Vec3<T> direction;

  /// ψ [Pa].
  EVERT_ALWAYS_INLINE T energy(const Svd3<T>& svd) const {
    return model.matrix().energy(svd.sigma) + model.fibre_energy(stretch(svd.sigma, in_frame(svd)));
  }

  /// P̂ = Uᵀ P V [Pa].
  EVERT_ALWAYS_INLINE Mat3<T> stress_in_frames(const Svd3<T>& svd) const {
    const Vec3<T> b = in_frame(svd);
    const T pull = fibre_pull(model, stretch(svd.sigma, b));
    return diagonal(model.matrix().principal_stress(svd.sigma)) + outer(pull * stretched(svd.sigma, b), b);
  }

  /// b = Vᵀa.
  EVERT_ALWAYS_INLINE Vec3<T> in_frame(const Svd3<T>& svd) const { return transpose_times(svd.v, direction); }

  /// F̂ b.
  EVERT_ALWAYS_INLINE static Vec3<T> stretched(const Vec3<T>& sigma, const Vec3<T>& b) {
    return {sigma[0] * b[0], sigma[1] * b[1], sigma[2] * b[2]};
  }
  /// Λ.
  EVERT_ALWAYS_INLINE static T stretch(const Vec3<T>& sigma, const Vec3<T>& b) {
    const Vec3<T> now = stretched(sigma, b);
    return sqrt(dot(now, now));
  }
};

/// The model has fibres, and says what it is like where they run along a direction.
template <class Model>
concept HasFibres = requires(const Model& model, const Vec3d& direction) {
  { model.along(direction) } -> std::same_as<AlongFibre<Model, double>>;
};

/// P of any model [Pa]; `fibre` is the direction of its fibres, of which isotropic models have none.
template <class T, class Model>
EVERT_ALWAYS_INLINE Mat3<T> first_piola_kirchhoff(const Model& model, const Svd3<T>& svd,
                                                  const Vec3<T>& fibre) {
  if constexpr (HasFibres<Model>) {
    return times_transpose(svd.u * model.along(fibre).stress_in_frames(svd), svd.v);
  } else {
    return first_piola_kirchhoff(model, svd);
  }
}

/// ψ of any model [Pa].
template <class T, class Model>
EVERT_ALWAYS_INLINE T energy_density(const Model& model, const Svd3<T>& svd, const Vec3<T>& fibre) {
  if constexpr (HasFibres<Model>) {
    return model.along(fibre).energy(svd);
  } else {
    return model.energy(svd.sigma);
  }
}

}  // namespace evert
