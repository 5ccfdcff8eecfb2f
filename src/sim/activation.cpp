#include "evert/sim/activation.hpp"

#include <algorithm>
#include <limits>

namespace evert {

double Activation::at(double time) const {
  const auto later = std::ranges::upper_bound(keyframes, time, {}, &ActivationKeyframe::time);
  if (later == keyframes.begin()) return later->activation;
  const auto earlier = later - 1;
  if (later == keyframes.end()) return earlier->activation;
  const double share = (time - earlier->time) / (later->time - earlier->time);
  return earlier->activation + share * (later->activation - earlier->activation);
}

double Activation::next_keyframe(double time) const {
  const auto later = std::ranges::upper_bound(keyframes, time, {}, &ActivationKeyframe::time);
  return later == keyframes.end() ? std::numeric_limits<double>::infinity() : later->time;
}

double Activation::rise(double time, double end) const {
  const double now = at(time);
  double highest = std::max(now, at(end));
  for (const auto& key : keyframes)
    if (key.time > time && key.time < end) highest = std::max(highest, key.activation);
  return highest - now;
}

}  // namespace evert
