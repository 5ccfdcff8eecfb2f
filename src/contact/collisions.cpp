#include "evert/contact/collisions.hpp"

#include <algorithm>

#include "evert/math/nodal.hpp"

namespace evert {
namespace {

/// The share of a tangential velocity of size `speed` that Coulomb friction takes away when the normal velocity
/// changes by `normal_change` ≥ 0: 1 is sticking.  PHYSICS 8
double friction_share(double coefficient, double normal_change, double speed) {
  const double change = coefficient * normal_change;
  return change >= speed ? 1.0 : change / speed;
}

/// Takes the part of `v` relative to `body_velocity` and along the surface, and applies friction to it.
Vec3d rub(const Vec3d& v, const Vec3d& body_velocity, const Vec3d& normal, double coefficient, double normal_change) {
  const auto relative = v - body_velocity;
  const auto tangential = relative - dot(relative, normal) * normal;
  const double speed = norm(tangential);
  if (speed == 0) return v;
  return v - friction_share(coefficient, normal_change, speed) * tangential;
}

}  // namespace

Collisions::Collisions(std::vector<std::unique_ptr<Obstacle>> obstacles, std::span<const double> masses)
    : obstacles_(std::move(obstacles)), masses_(masses) {
  // The step allocates nothing: room for every node in every obstacle. Untouched pages cost no memory.
  contacts_.reserve(masses.size() * obstacles_.size());
  if (!obstacles_.empty()) constraints_.reserve(masses.size());
}

Obstacle* Collisions::find(const std::string& name) const {
  const auto found =
      std::find_if(obstacles_.begin(), obstacles_.end(), [&](const auto& obstacle) { return obstacle->name() == name; });
  return found == obstacles_.end() ? nullptr : found->get();
}

void Collisions::resolve(std::span<double> x, std::span<double> v, std::span<const double> predicted,
                         std::span<const NodeConstraint> prescribed, const StepInterval& step) {
  contacts_.clear();
  constraints_.clear();
  impulse_ = {};
  if (obstacles_.empty()) return;
  const auto nodes = static_cast<LocalIndex>(masses_.size());
  auto fixed = prescribed.begin();
  for (LocalIndex node = 0; node < nodes; ++node) {
    while (fixed != prescribed.end() && fixed->node < node) ++fixed;
    if (fixed != prescribed.end() && fixed->node == node && fixed->free == Mat3d{}) continue;
    auto position = node_value(x, node);
    auto velocity = node_value(v, node);
    const auto first_contact = contacts_.size();
    resolve_node(node, position, velocity, node_value(predicted, node), step);
    if (contacts_.size() == first_contact) continue;
    impulse_ += masses_[static_cast<std::size_t>(node)] * (velocity - node_value(v, node));
    set_node_value(x, node, position);
    set_node_value(v, node, velocity);
    constrain(first_contact, velocity);
  }
}

void Collisions::resolve_node(LocalIndex node, Vec3d& x, Vec3d& v, Vec3d predicted, const StepInterval& step) {
  for (const auto& obstacle : obstacles_) {
    const double distance = obstacle->signed_distance(x, step.end);
    if (distance >= 0) continue;
    const auto normal = obstacle->normal(x, step.end);
    const auto body_velocity = obstacle->velocity(x, step.end);
    // The position: out of the body, which is a change −φ/Δt of the velocity that led here, with its friction.
    const auto rubbed = rub(predicted, body_velocity, normal, obstacle->friction(), -distance / step.dt);
    x += step.dt * (rubbed - predicted) - distance * normal;
    predicted = rubbed;
    // The velocity: an inelastic impact, unless the node separates already.
    const double approach = std::max(0.0, -dot(v - body_velocity, normal));
    v = rub(v + approach * normal, body_velocity, normal, obstacle->friction(), approach);
    contacts_.push_back({node, obstacle.get(), normal, body_velocity});
  }
}

void Collisions::constrain(std::size_t first_contact, const Vec3d& v) {
  NodeConstraint constraint{contacts_[first_contact].node, {}, {}};
  std::array<Vec3d, 3> normals{};  // a fourth independent direction does not exist
  const auto count = std::min(contacts_.size() - first_contact, normals.size());
  for (std::size_t i = 0; i < count; ++i) normals[i] = contacts_[first_contact + i].normal;
  constraint.free = projector_off(std::span(normals).first(count));
  constraint.prescribed = v - constraint.free * v;
  constraints_.push_back(constraint);
}

void Collisions::apply_friction(std::span<double> v, std::span<const double> reaction) {
  for (const auto& contact : contacts_) {
    const double mass = masses_[static_cast<std::size_t>(contact.node)];
    const double normal_change = std::max(0.0, dot(node_value(reaction, contact.node), contact.normal)) / mass;
    const auto before = node_value(v, contact.node);
    const auto after = rub(before, contact.body_velocity, contact.normal, contact.obstacle->friction(), normal_change);
    impulse_ += mass * (after - before);
    set_node_value(v, contact.node, after);
  }
}

}  // namespace evert
