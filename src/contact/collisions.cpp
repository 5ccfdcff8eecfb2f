#include "evert/contact/collisions.hpp"

#include "evert/core/formatted.hpp"
#include "evert/math/nodal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evert {
namespace {

// Nodes are numbered for locality: so many neighbours share one search for the bodies that are near.
constexpr LocalIndex chunk = 64;
// Bodies that a node is in at once, for which there is room without allocation in a step.
constexpr std::size_t usual_touches = 4;
// Sliding slower than this share of the velocities involved is rounding.
constexpr double standstill = 1e-12;
// Beyond, the way of a node relative to a body is no straight line [rad].
constexpr double fast_turn = 0.5;

/// Friction on a sliding velocity that may change it by `most`: it shrinks by that and never turns round.
/// PHYSICS 8
Vec3d rubbed(const Vec3d& sliding, double most) {
  const double speed = norm(sliding);
  return most >= speed ? Vec3d{} : (1 - most / speed) * sliding;
}

/// True where friction against `sliding` has turned the motion off it by more than 60 degrees: it is strong
/// enough to stop the node, and only the lag of its direction makes the node move.
bool is_turned(const Vec3d& motion, const Vec3d& sliding) {
  return dot(motion, sliding) < 0.5 * norm(motion) * norm(sliding);
}

/// True where the cones of friction of two bodies see each other along the normals: pressed together, the
/// bodies then hold what is between them, and it cannot slip out of the gap.
bool grips(const Vec3d& normal, double friction, const Vec3d& other, double other_friction) {
  const double cosine = -dot(normal, other);
  return cosine > 0 &&
         cosine * std::hypot(1, friction) * std::hypot(1, other_friction) >= 1 - friction * other_friction;
}

double angle_between(const Mat3d& a, const Mat3d& b) {
  return 2 * std::asin(std::min(1.0, norm(a - b) / std::sqrt(8.0)));
}

}  // namespace

Collisions::Collisions(std::vector<std::unique_ptr<Obstacle>> obstacles, std::span<const double> masses)
    : obstacles_(std::move(obstacles)),
      standing_(obstacles_, masses.size()),
      masses_(masses),
      given_(obstacles_.size()),
      warned_(obstacles_.size()) {
  // The step allocates nothing: room for every node. Untouched pages cost no memory.
  if (obstacles_.empty()) return;
  contacts_.reserve(masses.size());
  constraints_.reserve(masses.size());
  touches_.reserve(masses.size() * std::min(obstacles_.size(), usual_touches));
  bounds_.reserve(obstacles_.size());
  shares_.reserve(obstacles_.size());
}

Obstacle* Collisions::find(const std::string& name) const {
  const auto found = std::find_if(obstacles_.begin(), obstacles_.end(),
                                  [&](const auto& obstacle) { return obstacle->name() == name; });
  return found == obstacles_.end() ? nullptr : found->get();
}

/// impulse(contact) for each in turn, to the bodies that it touches.
void Collisions::share_out(auto&& impulse) {
  std::fill(given_.begin(), given_.end(), ObstacleImpulse{});
  for (const auto& contact : contacts_) {
    const Vec3d total = impulse(contact);
    const auto along = contact.tangent * total;
    const double most = most_friction(contact, total);  // fills shares_
    const auto touches = touches_of(contact);
    for (std::size_t k = 0; k < touches.size(); ++k) {
      const double share = most > 0 ? friction(touches[k]) * std::max(0.0, shares_[k]) / most
                                    : 1 / static_cast<double>(touches.size());
      const auto given = shares_[k] * touches[k].normal + share * along;
      auto& sum = given_[touches[k].obstacle];
      sum.linear += given;
      sum.angular += cross(contact.position - body(touches[k]).state().origin, given);
    }
  }
}

// --- from xⁿ to x̃

const StandingNodes& Collisions::find_standing(std::span<const double> x, std::span<const double> v,
                                               std::span<const double> f,
                                               std::span<const NodeConstraint> prescribed,
                                               const StepInterval& step) {
  for (const auto& obstacle : obstacles_)
    if (obstacle->body() == nullptr) obstacle->move_to(step);
  standing_.find({masses_, x, v, f}, prescribed, step.dt);
  return standing_;
}

// --- from x̃ to xⁿ⁺¹

void Collisions::resolve(std::span<double> x, std::span<double> v, std::span<const double> predicted,
                         std::span<const NodeConstraint> prescribed, const StepInterval& step) {
  contacts_.clear();
  touches_.clear();
  constraints_.clear();
  if (obstacles_.empty()) return;
  for (const auto& obstacle : obstacles_) obstacle->move_to(step);
  warn_of_turns(step.end);
  const auto nodes = static_cast<LocalIndex>(masses_.size());
  for (LocalIndex begin = 0; begin < nodes; begin += chunk) {
    const auto end = std::min(begin + chunk, nodes);
    const auto near = search_.near(around(box_of(begin, end, x, predicted, step.dt)));
    if (near.empty()) continue;
    auto fixed = std::lower_bound(prescribed.begin(), prescribed.end(), begin,
                                  [](const NodeConstraint& c, LocalIndex node) { return c.node < node; });
    for (auto node = begin; node < end; ++node) {
      while (fixed != prescribed.end() && fixed->node < node) ++fixed;
      if (fixed != prescribed.end() && fixed->node == node && fixed->free == Mat3d{}) continue;
      resolve_node(node, x, v, predicted, near, step.dt);
    }
  }
  standing_.clear();
  share_out([](const Contact& contact) { return contact.impulse; });
}

/// Around the ways of some nodes.
Box3 Collisions::box_of(LocalIndex begin, LocalIndex end, std::span<const double> x,
                        std::span<const double> predicted, double dt) const {
  Box3 box;
  for (auto node = begin; node < end; ++node) {
    const auto to = node_value(x, node);
    box.include(to);
    box.include(to - dt * node_value(predicted, node));
  }
  return box;
}

void Collisions::resolve_node(LocalIndex node, std::span<double> x, std::span<double> v,
                              std::span<const double> predicted, std::span<const std::size_t> near,
                              double dt) {
  const auto led = node_value(predicted, node), reached = node_value(x, node);
  Way way{reached - dt * led, reached};
  Contact contact{.node = node, .first_touch = touches_.size()};
  search_.find(way, near, touches_);
  standing_.add_touches(node, way.to, contact.first_touch, touches_);
  if (touches_.size() == contact.first_touch) return;

  const auto out = leave(contact, way, near);
  const auto touches = touches_of(contact);
  const double out_friction = most_friction(contact, out.change) / dt;
  contact.position = way.to + out.change;

  // The velocity: an inelastic impact, unless the node separates already.
  const auto before = node_value(v, node);
  bounds_.clear();
  for (const auto& touch : touches)
    bounds_.push_back({touch.normal, dot(touch.normal, body(touch).velocity(contact.position) - before)});
  const auto impact = push_out(bounds_);
  contact.pinched = out.pinched || impact.pinched;
  contact.surface_velocity =
      mean_velocity(touches, [&](const Obstacle& obstacle) { return obstacle.velocity(contact.position); });
  const auto sliding = contact.tangent * (before + impact.change - contact.surface_velocity);
  const auto slides_on = rubbed(sliding, most_friction(contact, impact.change));
  const bool rough =
      std::any_of(touches.begin(), touches.end(), [&](const Touch& touch) { return friction(touch) > 0; });
  const bool stays =
      rough && (contact.pinched ||
                norm(slides_on) <= standstill * (norm(before) + norm(led) + norm(contact.surface_velocity)));
  // How hard a body is hit that gives way, the solve will say: all of its impulse is left to that, and it
  // holds the node as long as friction may.
  contact.yields = std::any_of(touches.begin(), touches.end(),
                               [&](const Touch& touch) { return body(touch).body() != nullptr; });
  contact.sticks = stays || (rough && contact.yields);
  const auto after = before + impact.change + (contact.sticks ? Vec3d{} : slides_on) - sliding;
  if (!contact.yields) {
    contact.impulse = masses_[static_cast<std::size_t>(node)] * (after - before);
    set_node_value(v, node, after);
  }

  // The position: out of the bodies, which is a change of the velocity that led here, with its friction.
  const auto carried = mean_velocity(
      touches, [&](const Obstacle& obstacle) { return obstacle.mean_velocity(contact.position); });
  const auto led_along = contact.tangent * (led - carried);
  const auto left_along = stays ? Vec3d{} : rubbed(led_along, out_friction);
  contact.position += dt * (left_along - led_along);
  set_node_value(x, node, contact.position);
  contacts_.push_back(contact);
  constrain(contact, after);
}

/// Out of the bodies that the way led into, and of those that this leads into.
PushOut Collisions::leave(Contact& contact, const Way& way, std::span<const std::size_t> near) {
  constexpr int most_rounds = 3;
  PushOut out;
  for (int round = 0; round < most_rounds; ++round) {
    bounds_.clear();
    contact.touches = touches_.size() - contact.first_touch;
    face_each_other(std::span(touches_).subspan(contact.first_touch));
    for (const auto& touch : touches_of(contact)) bounds_.push_back({touch.normal, touch.depth});
    out = push_out(bounds_);
    if (out.pinched || round + 1 == most_rounds || !search_.find_after(way, out.change, near, touches_))
      break;
  }
  contact.tangent = tangent_of(bounds_);
  return out;
}

/// Two bodies that grip what is between them press along one line, the mean of their normals. By the normals
/// themselves a node between two surfaces that close in at an angle would be moved out of the gap, which
/// their friction forbids, and all the way to where they meet.
void Collisions::face_each_other(std::span<Touch> touches) const {
  double most_opposed = 0;
  Touch *one = nullptr, *other = nullptr;
  for (std::size_t i = 0; i < touches.size(); ++i)
    for (std::size_t j = i + 1; j < touches.size(); ++j) {
      const auto &a = touches[i], &b = touches[j];
      const double cosine = dot(a.normal, b.normal);
      if (cosine >= most_opposed || !grips(a.normal, friction(a), b.normal, friction(b))) continue;
      most_opposed = cosine, one = &touches[i], other = &touches[j];
    }
  if (one == nullptr) return;
  const auto apart = one->normal - other->normal;
  const double size = norm(apart);
  for (auto* touch : {one, other}) touch->depth *= 2 / size;  // along a line that is oblique to the surface
  one->normal = (1 / size) * apart;
  other->normal = (-1 / size) * apart;
}

/// Of the bodies, weighted with their coefficients of friction; plain where none has any.
Vec3d Collisions::mean_velocity(std::span<const Touch> touches, auto&& velocity) const {
  Vec3d sum{}, weighted{};
  double weights = 0;
  for (const auto& touch : touches) {
    const Vec3d of_body = velocity(body(touch));
    sum += of_body;
    weighted += friction(touch) * of_body;
    weights += friction(touch);
  }
  if (weights > 0) return (1 / weights) * weighted;
  return (1 / static_cast<double>(touches.size())) * sum;
}

/// What Coulomb allows along the surface while the bodies exert `impulse`, or a change of velocity or
/// position; adhesion allows none.
double Collisions::most_friction(const Contact& contact, const Vec3d& impulse) {
  const auto touches = touches_of(contact);
  bounds_.clear();
  for (const auto& touch : touches) bounds_.push_back({touch.normal, 0});
  split_over(bounds_, contact.tangent, impulse, shares_);
  double most = 0;
  for (std::size_t k = 0; k < touches.size(); ++k) most += friction(touches[k]) * std::max(0.0, shares_[k]);
  return most;
}

void Collisions::warn_of_turns(double end) {
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const double turn = angle_between(obstacles_[i]->before().rotation, obstacles_[i]->state().rotation);
    if (turn < fast_turn || warned_[i]) continue;
    warned_[i] = true;
    notes_.push_back(formatted("t = %.6g s: obstacle '", end) + obstacles_[i]->name() +
                     formatted("' turns by %.0f degrees in one step: what it should push may pass through "
                               "it; a smaller integrator.time_step helps",
                               turn * 180 / std::numbers::pi));
  }
}

// --- during the solve

void Collisions::constrain(const Contact& contact, Vec3d v) {
  NodeConstraint constraint{contact.node, {}, {}};
  if (contact.sticks)
    v -= contact.tangent * (v - contact.surface_velocity);
  else
    constraint.free = contact.tangent;
  constraint.prescribed = v - constraint.free * v;
  constraints_.push_back(constraint);
}

FrictionError Collisions::friction_error(std::span<const double> v, std::span<const double> reaction) {
  FrictionError error;
  for (const auto& before : contacts_) {
    const auto exerted = node_value(reaction, before.node);
    const auto after = after_solve(before, node_value(v, before.node), exerted);
    const double allowed = most_friction(before, exerted);
    error.allowed += allowed;
    if (before.sticks) {
      error.excess += after.sticks ? 0 : norm(before.tangent * exerted) - allowed;
    } else {
      error.excess += norm(after.friction - before.friction);
    }
  }
  return error;
}

void Collisions::slide(std::span<const double> v, std::span<double> reaction) {
  constraints_.clear();
  for (auto& contact : contacts_) {
    const auto velocity = node_value(v, contact.node), exerted = node_value(reaction, contact.node);
    const auto after = after_solve(contact, velocity, exerted);
    set_node_value(reaction, contact.node, exerted - (after.friction - contact.friction));
    contact = after;
    constrain(contact, velocity);
  }
}

/// Coulomb's law for one contact: whether it sticks, and the impulse on it if not. What sticks again sticks
/// for the rest of the step: let go once more it would come round once more, and leave a step in which it
/// moves. What is pinched is held: its reaction does not show how hard the bodies press.
Collisions::Contact Collisions::after_solve(Contact contact, const Vec3d& velocity, const Vec3d& reaction) {
  const double allowed = most_friction(contact, reaction);
  const bool stuck = contact.sticks;
  const auto held = contact.tangent * reaction;
  const auto motion = contact.tangent * (velocity - contact.surface_velocity);
  contact.sticks = stuck ? contact.pinched || contact.stopped || norm(held) <= allowed
                         : is_turned(motion, contact.sliding);
  contact.stopped = contact.stopped || (contact.sticks && !stuck);
  const auto towards = stuck ? -held : motion;
  const double size = norm(towards);
  contact.sliding = contact.sticks || size == 0 ? Vec3d{} : (1 / size) * towards;
  contact.friction = -allowed * contact.sliding;
  return contact;
}

/// The normal part of the change is that which the normals of all bodies see: none of those that have not
/// changed.
void Collisions::follow(std::size_t obstacle, const RigidState& before) {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    auto& contact = contacts_[i];
    const auto touches = touches_of(contact);
    const auto is_touched = [obstacle](const Touch& touch) { return touch.obstacle == obstacle; };
    if (std::none_of(touches.begin(), touches.end(), is_touched)) continue;
    const auto change =
        obstacles_[obstacle]->velocity(contact.position) - before.velocity_at(contact.position);
    Vec3d through{};
    auto open = identity<double>();
    for (const auto& touch : touches) {
      const auto left = open * touch.normal;
      const double square = dot(left, left);
      if (square < 1e-12) continue;  // the normals before say it
      const double wanted = is_touched(touch) ? dot(touch.normal, change) : 0;
      through += ((wanted - dot(touch.normal, through)) / square) * left;
      open -= (1 / square) * outer(left, left);
    }
    const auto surface =
        mean_velocity(touches, [&](const Obstacle& one) { return one.velocity(contact.position); });
    const auto along = contact.tangent * (surface - contact.surface_velocity);
    constraints_[i].prescribed += through + (contact.sticks ? along : Vec3d{});
    contact.surface_velocity = surface;
  }
}

// --- after it

void Collisions::stop_reversed(std::span<double> v) {
  for (auto& contact : contacts_) {
    const auto velocity = node_value(v, contact.node);
    const auto sliding = contact.tangent * (velocity - contact.surface_velocity);
    if (contact.yields || !is_turned(sliding, contact.sliding)) continue;
    set_node_value(v, contact.node, velocity - sliding);
    contact.impulse -= masses_[static_cast<std::size_t>(contact.node)] * sliding;
  }
}

void Collisions::share_impulses(std::span<const double> reaction, std::span<const NodeConstraint> prescribed,
                                std::span<const NodeConstraint> all) {
  auto fixed = prescribed.begin();
  auto constraint = all.begin();
  share_out([&](const Contact& contact) {
    while (constraint->node < contact.node) ++constraint;  // every contact is among them
    while (fixed != prescribed.end() && fixed->node < contact.node) ++fixed;
    const auto r = node_value(reaction, contact.node);
    const auto open = fixed != prescribed.end() && fixed->node == contact.node ? fixed->free * r : r;
    return contact.impulse + contact.friction + (open - constraint->free * r);
  });
}

Vec3d Collisions::impulse() const {
  Vec3d sum{};
  for (const auto& given : given_) sum += given.linear;
  return sum;
}

}  // namespace evert
