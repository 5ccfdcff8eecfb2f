#include "evert/contact/standing_nodes.hpp"

#include "evert/math/nodal.hpp"
#include "evert/shapes/implicit_surface.hpp"

#include <algorithm>
#include <cmath>

namespace evert {
namespace {

// Of the velocities involved: what rounding leaves of one that is the body's.
constexpr double standstill = 1e-12;
// Of what the forces change in a step: a node whose velocity away from the surface is less does not leave it.
constexpr double not_leaving = 1e-9;

/// What takes the material of a body from `x` at the beginning of the step to where it is at the end [m/s].
Vec3d velocity_of_way(const Obstacle& obstacle, const Vec3d& x, double dt) {
  const auto &before = obstacle.before(), &now = obstacle.state();
  if (before.origin == now.origin && before.rotation == now.rotation)
    return {};  // and not what rounding says
  return (1 / dt) * (now.to_world(before.to_body(x)) - x);
}

}  // namespace

/// Bodies with a mass are not among them: they go where the nodes let them go. Nor are curved surfaces:
/// friction along them leaves gaps, which are small, and what of them is a gap would hang on rounding.
StandingNodes::StandingNodes(std::span<const std::unique_ptr<Obstacle>> obstacles, std::size_t nodes)
    : obstacles_(obstacles) {
  for (std::size_t i = 0; i < obstacles.size(); ++i)
    if (obstacles[i]->body() == nullptr &&
        dynamic_cast<const HalfSpace*>(&obstacles[i]->surface()) != nullptr)
      planes_.push_back(i);
  if (planes_.empty()) return;
  feet_.reserve(nodes);
  constraints_.reserve(nodes);
  friction_.reserve(nodes);
  normals_.reserve(planes_.size());
  shares_.reserve(planes_.size());
}

void StandingNodes::clear() {
  feet_.clear();
  constraints_.clear();
  friction_.clear();
  asked_ = 0;
}

void StandingNodes::find(const NodalState& state, std::span<const NodeConstraint> prescribed, double dt) {
  clear();
  if (planes_.empty()) return;
  auto fixed = prescribed.begin();
  for (LocalIndex node = 0; node < static_cast<LocalIndex>(state.masses.size()); ++node) {
    while (fixed != prescribed.end() && fixed->node < node) ++fixed;
    if (fixed == prescribed.end() || fixed->node != node) look_at(node, state, dt);
  }
}

/// A node that friction can stop within half of the step goes with the body altogether.
void StandingNodes::look_at(LocalIndex node, const NodalState& state, double dt) {
  const auto x = node_value(state.x, node), v = node_value(state.v, node), f = node_value(state.f, node);
  const double mass = state.masses[static_cast<std::size_t>(node)];
  normals_.clear();
  const auto first = feet_.size();
  for (const auto i : planes_)
    if (stands_on(*obstacles_[i], x, v, dt / mass * f)) feet_.push_back({node, i});
  if (feet_.size() == first) return;

  const auto& body = *obstacles_[feet_[first].obstacle];
  const auto way = velocity_of_way(body, x, dt);
  const auto tangent = tangent_of(normals_);
  split_over(normals_, tangent, -f, shares_);
  double most_friction = 0;
  for (std::size_t k = 0; k < normals_.size(); ++k) {
    const auto& other = *obstacles_[feet_[first + k].obstacle];
    const auto apart = velocity_of_way(other, x, dt) - way;
    if (shares_[k] < 0 || norm(apart) > standstill * norm(way)) return feet_.resize(first);
    most_friction += other.friction() * shares_[k];
  }
  const double half = dt / 2;
  const auto towards = tangent * (mass * (v - body.before().velocity_at(x)) + half * f);
  const double most = half * most_friction, size = norm(towards);
  const bool sticks = most_friction > 0 && size <= most;
  const auto free = sticks ? Mat3d{} : tangent;
  constraints_.push_back({node, free, way - free * way});
  friction_.push_back(sticks || size == 0 ? Vec3d{} : (-most / size) * towards);
}

/// Notes the normal, if so. `impulse` of the forces in the step, over the mass [m/s].
bool StandingNodes::stands_on(const Obstacle& obstacle, const Vec3d& x, const Vec3d& v,
                              const Vec3d& impulse) {
  const auto& body = obstacle.before();
  const auto place = body.to_body(x);
  const double gap = std::abs(obstacle.surface().signed_distance(place));
  if (gap > on_surface * (norm(x) + norm(place)) || !obstacle.is_there()) return false;
  const auto normal = body.rotation * obstacle.surface().normal(place), velocity = body.velocity_at(x);
  const double pressed = -dot(normal, impulse);
  if (!(pressed > 0)) return false;
  const double rounding = standstill * (norm(v) + norm(velocity)) + not_leaving * pressed;
  if (std::abs(dot(normal, v - velocity)) > rounding) return false;
  normals_.push_back({normal, 0});
  return true;
}

void StandingNodes::add_touches(LocalIndex node, const Vec3d& place, std::size_t first,
                                std::vector<Touch>& touches) {
  while (asked_ < feet_.size() && feet_[asked_].node < node) ++asked_;
  for (; asked_ < feet_.size() && feet_[asked_].node == node; ++asked_) {
    const auto number = feet_[asked_].obstacle;
    if (std::any_of(touches.begin() + static_cast<std::ptrdiff_t>(first), touches.end(),
                    [&](const Touch& touch) { return touch.obstacle == number; }))
      continue;
    const auto& obstacle = *obstacles_[number];
    touches.push_back({number, obstacle.normal(place), -obstacle.signed_distance(place)});
  }
}

}  // namespace evert
