#include "evert/contact/rigid_contacts.hpp"

#include "evert/math/svd3_stages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evert {
namespace {

/// Where an obstacle is; of a body, where it has got to within the step.
RigidState now(const Obstacle& obstacle) {
  return obstacle.body() == nullptr ? obstacle.state()
                                    : obstacle.body()->at(std::numeric_limits<double>::infinity());
}

// Bodies that one touches at once with all of its points, for which there is room without allocation.
constexpr std::size_t usual_others = 4;

/// A support point of a body in another.
struct Overlap {
  double depth = 0;  // [m] not positive outside
  Vec3d normal{};    // out of the other
  Vec3d place{};     // on the surface of the support
};

Overlap overlap(const SupportPoint& support, const RigidState& inner, const RigidState& outer,
                const ImplicitSurface& surface) {
  const auto center = inner.to_world(support.center), in_outer = outer.to_body(center);
  const double distance = surface.signed_distance(in_outer) - support.radius;
  if (distance >= 0) return {};
  const auto normal = outer.rotation * surface.normal(in_outer);
  return {-distance, normal, center - support.radius * normal};
}

}  // namespace

RigidContacts::RigidContacts(std::span<const std::unique_ptr<Obstacle>> obstacles)
    : obstacles_(obstacles), support_(obstacles.size()), given_(obstacles.size()) {
  const auto is_body = [](const auto& obstacle) { return obstacle->body() != nullptr; };
  const auto bodies = static_cast<std::size_t>(std::count_if(obstacles.begin(), obstacles.end(), is_body));
  if (bodies == 0) return;
  std::size_t most = 0;
  for (std::size_t o = 0; o < obstacles.size(); ++o) {
    support_[o] = support_points(obstacles[o]->surface());
    most += support_[o].size();
  }
  // The step allocates nothing: room for every support point in some other bodies.
  contacts_.reserve(most * std::min(obstacles.size(), usual_others));
}

void RigidContacts::find() {
  contacts_.clear();
  std::fill(given_.begin(), given_.end(), std::pair<Vec3d, Vec3d>{});
  for (std::size_t body = 0; body < obstacles_.size(); ++body) {
    if (obstacles_[body]->body() == nullptr) continue;
    for (std::size_t other = 0; other < obstacles_.size(); ++other) {
      const bool seen = other <= body && obstacles_[other]->body() != nullptr;
      if (seen) continue;
      const auto before = contacts_.size();
      find(body, other);
      if (contacts_.size() == before) find(other, body);
    }
  }
}

void RigidContacts::find(std::size_t inner, std::size_t outer) {
  const auto& a = *obstacles_[inner];
  const auto& b = *obstacles_[outer];
  if (!a.bounds().overlaps(b.bounds())) return;
  const auto state_a = now(a), state_b = now(b);
  for (const auto& support : support_[inner]) {
    const auto [depth, normal, place] = overlap(support, state_a, state_b, b.surface());
    if (depth <= 0) continue;
    contacts_.push_back({inner, outer, &support, place, normal,
                         mobility(inner, place) + mobility(outer, place),
                         std::sqrt(a.friction() * b.friction())});
  }
}

bool RigidContacts::touches(std::size_t obstacle) const {
  return std::any_of(contacts_.begin(), contacts_.end(), [obstacle](const Contact& contact) {
    return contact.inner == obstacle || contact.outer == obstacle;
  });
}

Vec3d RigidContacts::velocity(std::size_t obstacle, const Vec3d& place) const {
  const auto* body = obstacles_[obstacle]->body();
  return body == nullptr ? obstacles_[obstacle]->velocity(place) : body->velocity_at(place);
}

Mat3d RigidContacts::mobility(std::size_t obstacle, const Vec3d& place) const {
  const auto* body = obstacles_[obstacle]->body();
  return body == nullptr ? Mat3d{} : body->mobility(place);
}

void RigidContacts::apply(const Contact& contact, const Vec3d& impulse) {
  if (auto* body = obstacles_[contact.inner]->body()) body->add_impulse(impulse, contact.place);
  if (auto* body = obstacles_[contact.outer]->body()) body->add_impulse(-impulse, contact.place);
}

/// Contact by contact, again and again until none changes: each takes the energy as low as its own impulse
/// can.
void RigidContacts::stop() {
  constexpr int most_rounds = 200;
  constexpr double settled = 1e-13;  // of all impulses
  for (int round = 0; round < most_rounds; ++round) {
    double change = 0, sum = 0;
    for (auto& contact : contacts_) {
      change = std::max(change, improve(contact));
      sum += norm(contact.impulse);
    }
    if (change <= settled * sum) break;
  }
  const auto give = [&](std::size_t giver, const Vec3d& impulse, const Vec3d& place) {
    given_[giver].first += impulse;
    given_[giver].second += cross(place - now(*obstacles_[giver]).origin, impulse);
  };
  for (const auto& contact : contacts_) {
    if (obstacles_[contact.inner]->body() != nullptr) give(contact.outer, contact.impulse, contact.place);
    if (obstacles_[contact.outer]->body() != nullptr) give(contact.inner, -contact.impulse, contact.place);
  }
}

/// The impulse along the surface in the place of `rubbed`: that which stops `sliding`, where it is at most
/// `most`. Else one step of projected descent, whose fixed point is against the sliding; the exact stop cut
/// short is not.
Vec3d RigidContacts::rubbing(const Contact& contact, const Vec3d& rubbed, const Vec3d& sliding, double most) {
  const auto [n, s, t] = frame_along(contact.normal);
  const double ss = dot(s, contact.mobility * s), st = dot(s, contact.mobility * t),
               tt = dot(t, contact.mobility * t), determinant = ss * tt - st * st;
  const double along_s = dot(s, sliding), along_t = dot(t, sliding);
  const auto stops = rubbed - ((tt * along_s - st * along_t) / determinant) * s -
                     ((ss * along_t - st * along_s) / determinant) * t;
  if (norm(stops) <= most) return stops;
  const double largest = (ss + tt) / 2 + std::sqrt((ss - tt) * (ss - tt) / 4 + st * st);
  const auto towards = rubbed - (1 / largest) * (along_s * s + along_t * t);
  return std::min(1.0, most / norm(towards)) * towards;
}

/// The normal impulse that stops the approach, then that along the surface which stops the sliding, or as
/// much of it as Coulomb allows. Returns by how much they changed.
double RigidContacts::improve(Contact& contact) {
  const auto relative = [&] {
    return velocity(contact.inner, contact.place) - velocity(contact.outer, contact.place);
  };
  const auto& n = contact.normal;
  const double pressed = dot(contact.impulse, n);
  const double presses = std::max(0.0, pressed - dot(n, relative()) / dot(n, contact.mobility * n));
  apply(contact, (presses - pressed) * n);

  const auto rubbed = contact.impulse - pressed * n;
  const auto rubs =
      contact.friction > 0 ? rubbing(contact, rubbed, relative(), contact.friction * presses) : Vec3d{};
  apply(contact, rubs - rubbed);
  contact.impulse = presses * n + rubs;
  return std::abs(presses - pressed) + norm(rubs - rubbed);
}

void RigidContacts::separate() {
  constexpr int most_rounds = 10;
  for (int round = 0; round < most_rounds; ++round) {
    bool inside = false;
    for (const auto& contact : contacts_) {
      const auto& outer = *obstacles_[contact.outer];
      const auto [depth, normal, place] =
          overlap(*contact.support, now(*obstacles_[contact.inner]), now(outer), outer.surface());
      if (depth <= 0) continue;
      inside = true;
      const auto both = mobility(contact.inner, place) + mobility(contact.outer, place);
      const auto impulse = (depth / dot(normal, both * normal)) * normal;
      if (auto* body = obstacles_[contact.inner]->body()) body->push(impulse, place);
      if (auto* body = obstacles_[contact.outer]->body()) body->push(-impulse, place);
    }
    if (!inside) break;
  }
}

}  // namespace evert
