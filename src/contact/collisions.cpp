#include "evert/contact/collisions.hpp"

#include "evert/math/nodal.hpp"

#include <algorithm>

namespace evert {
namespace {

/// The part along the surface of a velocity relative to the body's.
Vec3d along_surface(const Vec3d& relative, const Vec3d& normal) {
  return relative - dot(relative, normal) * normal;
}

/// Coulomb friction on a sliding velocity when the normal velocity changes by `normal_change` ≥ 0: it shrinks
/// by the coefficient times that and never turns round.  PHYSICS 8
Vec3d rubbed(const Vec3d& sliding, double coefficient, double normal_change) {
  const double speed = norm(sliding);
  const double change = coefficient * normal_change;
  return change >= speed ? Vec3d{} : (1 - change / speed) * sliding;
}

/// The impulse that Coulomb allows along the surface; adhesion allows none [N s].
double most_friction(const Obstacle& obstacle, const Vec3d& normal, const Vec3d& reaction) {
  return obstacle.friction() * std::max(0.0, dot(reaction, normal));
}

/// True where friction against `sliding` has turned the motion off it by more than 60 degrees: it is strong
/// enough to stop the node, and only the lag of its direction makes the node move.
bool is_turned(const Vec3d& motion, const Vec3d& sliding) {
  return dot(motion, sliding) < 0.5 * norm(motion) * norm(sliding);
}

/// Sliding slower than this share of the velocities involved is rounding.
constexpr double standstill = 1e-12;

}  // namespace

Collisions::Collisions(std::vector<std::unique_ptr<Obstacle>> obstacles, std::span<const double> masses)
    : obstacles_(std::move(obstacles)), masses_(masses) {
  // The step allocates nothing: room for every node in every obstacle. Untouched pages cost no memory.
  contacts_.reserve(masses.size() * obstacles_.size());
  if (!obstacles_.empty()) constraints_.reserve(masses.size());
}

Obstacle* Collisions::find(const std::string& name) const {
  const auto found = std::find_if(obstacles_.begin(), obstacles_.end(),
                                  [&](const auto& obstacle) { return obstacle->name() == name; });
  return found == obstacles_.end() ? nullptr : found->get();
}

void Collisions::resolve(std::span<double> x, std::span<double> v, std::span<const double> predicted,
                         std::span<const NodeConstraint> prescribed, const StepInterval& step) {
  contacts_.clear();
  constraints_.clear();
  impulse_ = {};
  if (obstacles_.empty()) return;
  for (const auto& obstacle : obstacles_) obstacle->move_to(step);
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
    constrain(std::span(contacts_).subspan(first_contact), velocity);
  }
}

void Collisions::resolve_node(LocalIndex node, Vec3d& x, Vec3d& v, Vec3d predicted,
                              const StepInterval& step) {
  for (const auto& obstacle : obstacles_) {
    const double distance = obstacle->signed_distance(x);
    if (distance >= 0) continue;
    const auto normal = obstacle->normal(x);
    const auto body_velocity = obstacle->velocity(x);
    // The velocity: an inelastic impact, unless the node separates already.
    const auto relative = v - body_velocity;
    const double approach = std::max(0.0, -dot(relative, normal));
    const auto sliding = along_surface(relative, normal);
    const auto slides_on = rubbed(sliding, obstacle->friction(), approach);
    v += approach * normal + (slides_on - sliding);
    const bool sticks =
        obstacle->friction() > 0 && norm(slides_on) <= standstill * (norm(v) + norm(body_velocity));
    // The position: out of the body, which is a change −φ/Δt of the velocity that led here, with its
    // friction.
    const auto led_along = along_surface(predicted - body_velocity, normal);
    const auto left_along = sticks ? Vec3d{} : rubbed(led_along, obstacle->friction(), -distance / step.dt);
    x += step.dt * (left_along - led_along) - distance * normal;
    predicted += left_along - led_along;
    contacts_.push_back({node, obstacle.get(), normal, body_velocity, sticks});
  }
}

void Collisions::constrain(std::span<const Contact> of_node, Vec3d v) {
  NodeConstraint constraint{of_node.front().node, {}, {}};
  const auto holding =
      std::find_if(of_node.begin(), of_node.end(), [](const Contact& contact) { return contact.sticks; });
  if (holding != of_node.end()) {
    v -= along_surface(v - holding->body_velocity, holding->normal);
  } else {
    std::array<Vec3d, 3> normals{};  // a fourth independent direction does not exist
    const auto count = std::min(of_node.size(), normals.size());
    for (std::size_t i = 0; i < count; ++i) normals[i] = of_node[i].normal;
    constraint.free = projector_off(std::span(normals).first(count));
  }
  constraint.prescribed = v - constraint.free * v;
  constraints_.push_back(constraint);
}

FrictionError Collisions::friction_error(std::span<const double> v, std::span<const double> reaction) const {
  FrictionError error;
  for (const auto& before : contacts_) {
    const auto exerted = node_value(reaction, before.node);
    const auto after = after_solve(before, node_value(v, before.node), exerted);
    const double allowed = most_friction(*before.obstacle, before.normal, exerted);
    error.allowed += allowed;
    if (before.sticks) {
      error.excess += after.sticks ? 0 : norm(along_surface(exerted, before.normal)) - allowed;
    } else {
      error.excess += norm(after.friction - before.friction);
    }
  }
  return error;
}

void Collisions::slide(std::span<const double> v, std::span<double> reaction) {
  constraints_.clear();
  for (std::size_t begin = 0, end = 0; begin < contacts_.size(); begin = end) {
    const auto node = contacts_[begin].node;
    const auto velocity = node_value(v, node);
    const auto exerted = node_value(reaction, node);
    auto left = exerted;
    for (end = begin; end < contacts_.size() && contacts_[end].node == node; ++end) {
      const auto after = after_solve(contacts_[end], velocity, exerted);
      left -= after.friction - contacts_[end].friction;
      contacts_[end] = after;
    }
    set_node_value(reaction, node, left);
    constrain(std::span(contacts_).subspan(begin, end - begin), velocity);
  }
}

/// Coulomb's law for one contact: whether it sticks, and the impulse on it if not. What sticks again sticks
/// for the rest of the step: let go once more it would come round once more, and leave a step in which it
/// moves.
Collisions::Contact Collisions::after_solve(Contact contact, const Vec3d& velocity, const Vec3d& reaction) {
  const double allowed = most_friction(*contact.obstacle, contact.normal, reaction);
  const bool stuck = contact.sticks;
  const auto held = along_surface(reaction, contact.normal);
  const auto motion = along_surface(velocity - contact.body_velocity, contact.normal);
  contact.sticks = stuck ? contact.stopped || norm(held) <= allowed : is_turned(motion, contact.sliding);
  contact.stopped = contact.stopped || (contact.sticks && !stuck);
  const auto towards = stuck ? -held : motion;
  const double size = norm(towards);
  contact.sliding = contact.sticks || size == 0 ? Vec3d{} : (1 / size) * towards;
  contact.friction = -allowed * contact.sliding;
  return contact;
}

Vec3d Collisions::friction() const {
  Vec3d sum{};
  for (const auto& contact : contacts_) sum += contact.friction;
  return sum;
}

void Collisions::stop_reversed(std::span<double> v) {
  for (const auto& contact : contacts_) {
    const auto velocity = node_value(v, contact.node);
    const auto sliding = along_surface(velocity - contact.body_velocity, contact.normal);
    if (!is_turned(sliding, contact.sliding)) continue;
    set_node_value(v, contact.node, velocity - sliding);
    impulse_ -= masses_[static_cast<std::size_t>(contact.node)] * sliding;
  }
}

}  // namespace evert
