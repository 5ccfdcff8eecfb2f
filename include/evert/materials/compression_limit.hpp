#pragma once
#include "evert/materials/lame.hpp"
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

#include <limits>

/// What the models that stiffen without bound under compression share: the stretches limited from below.
/// PHYSICS 3
namespace evert {

/// max(σ_i, limit).
template <class T>
EVERT_ALWAYS_INLINE Vec3<T> limited_stretches(const Vec3<T>& sigma, double limit) {
  return {max(sigma[0], T(limit)), max(sigma[1], T(limit)), max(sigma[2], T(limit))};
}

/// The stretches that a model is evaluated at: as they are, but with `Extension::clamp` the limited ones.
template <class T>
EVERT_ALWAYS_INLINE Vec3<T> evaluated_stretches(const Vec3<T>& sigma, double limit, Extension extension) {
  // No branch on each point: −∞ limits nothing.
  return limited_stretches(sigma,
                           extension == Extension::clamp ? limit : -std::numeric_limits<double>::infinity());
}

/// What such a model is made of, with c = max(σ, limit) and d = σ − c.
template <class T>
struct LimitedTerms {
  Vec3<T> sigma;  ///< the stretches evaluated at
  Vec3<T> c;
  Vec3<T> inverse;  ///< 1/c_i
  Vec3<T> ratio;    ///< d_i/c_i
  T volume;         ///< c_1 c_2 c_3
};

/// One division for the three inverses.
template <class T>
EVERT_ALWAYS_INLINE LimitedTerms<T> limited_terms(const Vec3<T>& stretches, double limit,
                                                  Extension extension) {
  const Vec3<T> sigma = evaluated_stretches(stretches, limit, extension);
  const Vec3<T> c = limited_stretches(sigma, limit);
  const T c01 = c[0] * c[1];
  const T volume = c01 * c[2];
  const T inverse_volume = T(1.0) / volume;
  const Vec3<T> inverse{inverse_volume * (c[1] * c[2]), inverse_volume * (c[0] * c[2]), inverse_volume * c01};
  return {sigma,
          c,
          inverse,
          {(sigma[0] - c[0]) * inverse[0], (sigma[1] - c[1]) * inverse[1], (sigma[2] - c[2]) * inverse[2]},
          volume};
}

/// How the limited stretches c = max(σ, limit) and the rest d = σ − c of two axes differ, per difference of
/// σ.
template <class T>
struct PairSlopes {
  T limited;  ///< (c_i − c_j)/(σ_i − σ_j): 1 above the limit, 0 below, in between where it lies between the
              ///< two
  T rest;  ///< (d_i − d_j)/(σ_i − σ_j); 0 with `clamp`, which evaluates at d = 0
};

/// Exact to rounding however near the two are, since nearby numbers are subtracted exactly.
template <class T>
EVERT_ALWAYS_INLINE PairSlopes<T> pair_slopes(const T& sigma_i, const T& sigma_j, double limit,
                                              Extension extension) {
  const T difference = sigma_i - sigma_j;
  const auto apart = abs(difference) > T(0.0);
  const T quotient = (max(sigma_i, T(limit)) - max(sigma_j, T(limit))) / select(apart, difference, T(1.0));
  const T limited = select(apart, quotient, select(sigma_i < T(limit), T(0.0), T(1.0)));
  return {limited, extension == Extension::clamp ? T(0.0) : T(1.0) - limited};
}

}  // namespace evert
