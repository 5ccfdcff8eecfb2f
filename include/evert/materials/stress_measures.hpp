#pragma once
#include "evert/math/svd3.hpp"
#include "evert/math/vec3.hpp"

/// Between the first Piola-Kirchhoff stress P, which elements need, and the stresses that publications give
/// models in. All are diagonal in the same frames; the conversions of principal values have the same names.
/// paper A, section 4
///
/// To P they are products, defined for every F. Back they divide by stretches: not finite where F is
/// singular.
namespace evert {

/// P = U diag(P̂) Vᵀ of an isotropic model [Pa].  paper A, eq. (1)
template <class T, class Model>
EVERT_ALWAYS_INLINE Mat3<T> first_piola_kirchhoff(const Model& model, const Svd3<T>& svd) {
  return times_transpose(svd.u * diagonal(model.principal_stress(svd.sigma)), svd.v);
}

/// P = F S of the second Piola-Kirchhoff stress S.
template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> first_from_second_piola_kirchhoff(const Mat3<T>& f, const Mat3<T>& s) {
  return f * s;
}
/// P̂_i = σ_i Ŝ_i
template <class T>
EVERT_ALWAYS_INLINE constexpr Vec3<T> first_from_second_piola_kirchhoff(const Vec3<T>& sigma,
                                                                        const Vec3<T>& s) {
  return {sigma[0] * s[0], sigma[1] * s[1], sigma[2] * s[2]};
}

/// P = J σ F⁻ᵀ of the Cauchy stress, J F⁻ᵀ being the cofactors of F.
template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> first_piola_kirchhoff_from_cauchy(const Mat3<T>& f,
                                                                        const Mat3<T>& cauchy) {
  return cauchy * cofactor(f);
}
/// P̂_i = σ_j σ_k × the Cauchy stress along axis i.
template <class T>
EVERT_ALWAYS_INLINE constexpr Vec3<T> first_piola_kirchhoff_from_cauchy(const Vec3<T>& sigma,
                                                                        const Vec3<T>& cauchy) {
  return {sigma[1] * sigma[2] * cauchy[0], sigma[0] * sigma[2] * cauchy[1], sigma[0] * sigma[1] * cauchy[2]};
}

/// S = F⁻¹ P
template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> second_from_first_piola_kirchhoff(const Mat3<T>& f, const Mat3<T>& p) {
  return inverse(f) * p;
}
template <class T>
EVERT_ALWAYS_INLINE constexpr Vec3<T> second_from_first_piola_kirchhoff(const Vec3<T>& sigma,
                                                                        const Vec3<T>& p) {
  return {p[0] / sigma[0], p[1] / sigma[1], p[2] / sigma[2]};
}

/// Cauchy stress P Fᵀ / J.
template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> cauchy_from_first_piola_kirchhoff(const Mat3<T>& f, const Mat3<T>& p) {
  return times_transpose(p, f) * (T(1) / determinant(f));
}
template <class T>
EVERT_ALWAYS_INLINE constexpr Vec3<T> cauchy_from_first_piola_kirchhoff(const Vec3<T>& sigma,
                                                                        const Vec3<T>& p) {
  return {p[0] / (sigma[1] * sigma[2]), p[1] / (sigma[0] * sigma[2]), p[2] / (sigma[0] * sigma[1])};
}

}  // namespace evert
