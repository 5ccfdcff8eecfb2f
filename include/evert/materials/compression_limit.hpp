#pragma once
#include "evert/materials/lame.hpp"
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

/// What the models that stiffen without bound under compression share: the stretches limited from below.
/// PHYSICS 3
namespace evert {

/// c_i = max(σ_i, limit).
template <class T>
constexpr Vec3<T> limited_stretches(const Vec3<T>& sigma, double limit) {
  return {max(sigma[0], T(limit)), max(sigma[1], T(limit)), max(sigma[2], T(limit))};
}

/// What `Extension::clamp` evaluates a model at: the limited stretches. `Extension::linear` takes σ as it is.
template <class T>
constexpr Vec3<T> evaluated_stretches(const Vec3<T>& sigma, double limit, Extension extension) {
  return extension == Extension::clamp ? limited_stretches(sigma, limit) : sigma;
}

}  // namespace evert
