#include "evert/contact/prescribed_motion.hpp"

#include <algorithm>

namespace evert {
namespace {

Vec3d interpolate(std::span<const VelocityKeyframe> keyframes, double t) {
  const auto later =
      std::find_if(keyframes.begin(), keyframes.end(), [t](const auto& key) { return key.time > t; });
  if (later == keyframes.begin()) return later->velocity;
  const auto earlier = later - 1;
  if (later == keyframes.end()) return earlier->velocity;
  const double share = (t - earlier->time) / (later->time - earlier->time);
  return earlier->velocity + share * (later->velocity - earlier->velocity);
}

/// The integral of the velocity, exact: linear from keyframe to keyframe.
Vec3d way(std::span<const VelocityKeyframe> keyframes, double begin, double end) {
  Vec3d sum{};
  const auto add = [&](double from, double to) {
    if (to > from) sum += 0.5 * (to - from) * (interpolate(keyframes, from) + interpolate(keyframes, to));
  };
  double reached = begin;
  for (const auto& key : keyframes) {
    add(reached, std::min(key.time, end));
    reached = std::max(reached, std::min(key.time, end));
  }
  add(reached, end);
  return sum;
}

NodeConstraint along_axes(const std::array<bool, 3>& axes, const Vec3d& velocity) {
  NodeConstraint constraint{};
  for (std::size_t k = 0; k < 3; ++k) {
    constraint.free(k, k) = axes[k] ? 0 : 1;
    constraint.prescribed[k] = axes[k] ? velocity[k] : 0;
  }
  return constraint;
}

}  // namespace

PrescribedMotion::PrescribedMotion(std::vector<PrescribedNodes> groups) : groups_(std::move(groups)) {
  std::size_t nodes = 0;
  for (const auto& group : groups_) nodes += group.nodes.size();
  for (auto* list : {&now_, &group_, &joined_}) list->reserve(nodes);
}

/// `prescribed` gives the vector of a group that acts at `t`.
template <class Prescribed>
std::span<const NodeConstraint> PrescribedMotion::join_groups(double t, Prescribed&& prescribed) {
  now_.clear();
  for (const auto& group : groups_) {
    if (t < group.from || t > group.until) continue;
    auto constraint = along_axes(group.axes, prescribed(group));
    group_.clear();
    for (const auto node : group.nodes) {
      constraint.node = node;
      group_.push_back(constraint);
    }
    join(now_, group_, joined_);
    std::swap(now_, joined_);
  }
  return now_;
}

std::span<const NodeConstraint> PrescribedMotion::at(double t) {
  return join_groups(t, [t](const PrescribedNodes& group) { return interpolate(group.keyframes, t); });
}

std::span<const NodeConstraint> PrescribedMotion::ways(double begin, double t) {
  return join_groups(
      t, [=](const PrescribedNodes& group) { return way(group.keyframes, std::max(begin, group.from), t); });
}

}  // namespace evert
