#include "evert/contact/keyframed_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evert {
namespace {

/// The slope at a key between two secants, per component: their weighted harmonic mean, and none where they
/// have opposite signs or one of them is zero.  Fritsch and Butland, 1984
Vec3d slope(const Vec3d& before, double duration_before, const Vec3d& after, double duration_after) {
  const double first = 2 * duration_after + duration_before, second = duration_after + 2 * duration_before;
  Vec3d result{};
  for (std::size_t k = 0; k < 3; ++k)
    if ((before[k] > 0 && after[k] > 0) || (before[k] < 0 && after[k] < 0))
      result[k] = (first + second) / (first / before[k] + second / after[k]);
  return result;
}

/// The angular velocity of exp(φ(t)) in the frame of the body, J φ′ with J = I − a [φ]× + b [φ]×², a = (1 −
/// cos θ)/θ², b = (θ − sin θ)/θ³, θ = |φ|.
Vec3d angular_velocity_of(const Vec3d& phi, const Vec3d& rate) {
  const double square = dot(phi, phi), angle = std::sqrt(square);
  const bool small = angle < 1e-4;  // where the next terms of the series are below rounding
  const double a = small ? 0.5 - square / 24 : (1 - std::cos(angle)) / square;
  const double b = small ? 1.0 / 6 - square / 120 : (angle - std::sin(angle)) / (square * angle);
  const auto once = cross(phi, rate);
  return rate - a * once + b * cross(phi, once);
}

/// The φ′ for which angular_velocity_of(φ, φ′) is `velocity`; |φ| ≤ π.
Vec3d rate_of(const Vec3d& phi, const Vec3d& velocity) {
  const double square = dot(phi, phi), angle = std::sqrt(square);
  const double b = angle < 1e-4 ? 1.0 / 12 + square / 720
                                : 1 / square - std::cos(angle / 2) / (2 * angle * std::sin(angle / 2));
  const auto once = cross(phi, velocity);
  return velocity + 0.5 * once + b * cross(phi, once);
}

}  // namespace

KeyframedMotion::KeyframedMotion(const RigidState& start, const Vec3d& about, std::vector<PoseKey> keys)
    : start_(start), about_(about), keys_(std::move(keys)) {
  for (auto& key : keys_) key.rotation = normalized(key.rotation);
  // Secants: the rotation vector from key to key is the same in the frames of both.
  const auto count = keys_.size() - 1;
  std::vector<double> durations(count);
  std::vector<Vec3d> ways(count), turns(count);
  for (std::size_t i = 0; i < count; ++i) {
    durations[i] = keys_[i + 1].time - keys_[i].time;
    ways[i] = keys_[i + 1].position - keys_[i].position;
    turns[i] = rotation_vector(conjugate(keys_[i].rotation) * keys_[i + 1].rotation);
  }
  const auto slopes = [&](const std::vector<Vec3d>& secants) {
    std::vector<Vec3d> all(keys_.size());  // at rest at both ends
    for (std::size_t i = 1; i < count; ++i)
      all[i] = slope((1 / durations[i - 1]) * secants[i - 1], durations[i - 1],
                     (1 / durations[i]) * secants[i], durations[i]);
    return all;
  };
  const auto velocities = slopes(ways), spins = slopes(turns);
  for (std::size_t i = 0; i < count; ++i)
    segments_.push_back({cubic(ways[i], velocities[i], velocities[i + 1], durations[i]),
                         cubic(turns[i], spins[i], rate_of(turns[i], spins[i + 1]), durations[i])});
}

KeyframedMotion::Cubic KeyframedMotion::cubic(const Vec3d& way, const Vec3d& rate_at_begin,
                                              const Vec3d& rate_at_end, double duration) {
  const auto mean = (1 / duration) * way;
  return {rate_at_begin, (1 / duration) * (3 * mean - 2 * rate_at_begin - rate_at_end),
          (1 / duration / duration) * (rate_at_begin + rate_at_end - 2 * mean)};
}

RigidState KeyframedMotion::at(double t) const {
  const auto later = std::ranges::upper_bound(keys_, t, {}, &PoseKey::time);
  if (later == keys_.begin() || later == keys_.end()) {
    const auto& key = later == keys_.begin() ? keys_.front() : keys_.back();
    return displaced(start_, about_, {rotation_matrix(key.rotation), key.position, {}, {}});
  }
  const auto number = static_cast<std::size_t>(later - keys_.begin()) - 1;
  const auto& key = keys_[number];
  const auto& [translation, turn] = segments_[number];
  const double since = t - key.time;
  const auto phi = turn.at(since);
  const auto rotation = rotation_matrix(key.rotation * quaternion_by(phi));
  return displaced(start_, about_,
                   {rotation, key.position + translation.at(since), translation.rate(since),
                    rotation * angular_velocity_of(phi, turn.rate(since))});
}

}  // namespace evert
