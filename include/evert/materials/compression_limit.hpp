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

}  // namespace evert
