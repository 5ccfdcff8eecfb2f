#include "evert/contact/contact_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace evert {
namespace {

// Steps of the search along a way, and halvings where it closes in on a surface.
constexpr double most_samples = 32;
constexpr int halvings = 50;

/// Where a straight way through the frame of a body goes into it.
class Entry {
 public:
  Entry(const ImplicitSurface& surface, const Vec3d& from, const Vec3d& to)
      : surface_(surface), from_(from), way_(to - from), length_(norm(way_)) {}

  /// Sphere tracing in steps that are not too small: the surface is nearer than the distance nowhere. A body
  /// thinner than a step shows in the normals, against the way before it and along it behind it. The share of
  /// the way.
  [[nodiscard]] std::optional<double> find() const {
    double outside = 0, distance = distance_at(0);
    bool approaching = approaches(0);
    while (outside < 1) {
      const double next = std::min(1.0, outside + std::max(distance / length_, 1 / most_samples));
      const double next_distance = distance_at(next);
      if (next_distance < 0) return between(outside, next);
      const bool next_approaching = approaches(next);
      if (approaching && !next_approaching && distance + next_distance < (next - outside) * length_)
        if (const auto inside = nearest(outside, next)) return between(outside, *inside);
      outside = next, distance = next_distance, approaching = next_approaching;
    }
    return {};
  }

  [[nodiscard]] Vec3d at(double share) const { return from_ + share * way_; }

 private:
  [[nodiscard]] double distance_at(double share) const { return surface_.signed_distance(at(share)); }
  [[nodiscard]] bool approaches(double share) const { return dot(surface_.normal(at(share)), way_) < 0; }

  /// From outside to inside.
  [[nodiscard]] double between(double outside, double inside) const {
    for (int i = 0; i < halvings; ++i) {
      const double middle = (outside + inside) / 2;
      (distance_at(middle) < 0 ? inside : outside) = middle;
    }
    return outside;
  }
  /// Between a place where the way comes nearer and one where it leaves: one that is inside, if any is.
  [[nodiscard]] std::optional<double> nearest(double nearer, double leaving) const {
    for (int i = 0; i < halvings; ++i) {
      const double middle = (nearer + leaving) / 2;
      if (distance_at(middle) < 0) return middle;
      (approaches(middle) ? nearer : leaving) = middle;
    }
    return {};
  }

  const ImplicitSurface& surface_;
  Vec3d from_, way_;
  double length_;
};

/// True where a way from outside, or from the surface, may have gone in on one side and be out, or nearer to
/// being out, on the other.
bool leads_through(const ImplicitSurface& surface, const Vec3d& from, const Vec3d& to,
                   const Vec3d& normal_at_end) {
  constexpr double on_surface = 1e-9;  // of the way: what rounding leaves of a distance of zero
  return dot(surface.normal(from), normal_at_end) < 0 &&
         surface.signed_distance(from) >= -on_surface * norm(to - from);
}

/// Where a way first leads through a body.
struct Passage {
  double share = 2;  // of the way; more than all of it: nowhere
  Touch touch{};
  Vec3d place{};  // at the end of the step
};

Passage passage_of(const Obstacle& obstacle, std::size_t number, const Way& way) {
  const auto& surface = obstacle.surface();
  const auto from = obstacle.before().to_body(way.from), to = obstacle.state().to_body(way.to);
  if (surface.signed_distance(to) >= norm(to - from)) return {};
  const auto normal = surface.normal(to);
  if (!leads_through(surface, from, to, normal)) return {};
  const Entry entry(surface, from, to);
  const auto share = entry.find();
  if (!share) return {};
  const auto place = entry.at(*share), outward = surface.normal(place);
  if (dot(outward, normal) >= 0) return {};
  return {*share, {number, obstacle.state().rotation * outward, 0}, obstacle.state().to_world(place)};
}

}  // namespace

ContactSearch::ContactSearch(std::span<const std::unique_ptr<Obstacle>> obstacles) : obstacles_(obstacles) {
  near_.reserve(obstacles.size());
}

std::span<const std::size_t> ContactSearch::near(const Box3& box) {
  near_.clear();
  for (std::size_t i = 0; i < obstacles_.size(); ++i)
    if (obstacles_[i]->bounds().overlaps(box)) near_.push_back(i);
  return near_;
}

void ContactSearch::find(Way& way, std::span<const std::size_t> near, std::vector<Touch>& touches) const {
  Box3 box;
  box.include(way.from);
  box.include(way.to);
  Passage first;
  for (const auto i : near) {
    if (!obstacles_[i]->bounds().overlaps(box)) continue;
    const auto passage = passage_of(*obstacles_[i], i, way);
    if (passage.share < first.share) first = passage;
  }
  if (first.share <= 1) {
    way.to = first.place;
    touches.push_back(first.touch);
  }
  for (const auto i : near) {
    const auto& obstacle = *obstacles_[i];
    if (!obstacle.bounds().contains(way.to) || (first.share <= 1 && first.touch.obstacle == i)) continue;
    const double distance = obstacle.signed_distance(way.to);
    if (distance < 0) touches.push_back({i, obstacle.normal(way.to), -distance});
  }
}

bool ContactSearch::find_after(const Way& way, const Vec3d& change, std::span<const std::size_t> near,
                               std::vector<Touch>& touches) const {
  // Of the change: what a curved surface or rounding leaves behind is no new contact.
  constexpr double negligible = 1e-6;
  const auto place = way.to + change;
  const auto known = touches.size();
  for (const auto i : near) {
    const auto& obstacle = *obstacles_[i];
    if (!obstacle.bounds().contains(place)) continue;
    const auto same = [&](const Touch& touch) { return touch.obstacle == i; };
    if (std::any_of(touches.begin(), touches.end(), same)) continue;
    const double distance = obstacle.signed_distance(place);
    if (distance >= -negligible * norm(change)) continue;
    const auto normal = obstacle.normal(place);
    touches.push_back({i, normal, dot(normal, change) - distance});
  }
  return touches.size() > known;
}

}  // namespace evert
