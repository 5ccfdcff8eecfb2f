#include "evert/contact/velocity_constraints.hpp"

#include "evert/math/nodal.hpp"

namespace evert {
namespace {

/// The projector onto the intersection of the ranges of two projectors, from the directions both leave fixed.
Mat3d intersect(const Mat3d& a, const Mat3d& b) {
  std::array<Vec3d, 6> fixed;
  for (std::size_t j = 0; j < 3; ++j) {
    fixed[j] = identity<double>().column[j] - a.column[j];
    fixed[3 + j] = identity<double>().column[j] - b.column[j];
  }
  return projector_off(fixed);
}

}  // namespace

Mat3d projector_off(std::span<const Vec3d> directions) {
  // Gram-Schmidt; what is left of a direction below this length is a combination of those before it.
  constexpr double independent = 1e-6;
  auto p = identity<double>();
  for (const auto& direction : directions) {
    auto left = p * direction;
    const double length = norm(left);
    if (length < independent) continue;
    left = (1 / length) * left;
    p -= outer(left, left);
  }
  return p;
}

void project(std::span<const NodeConstraint> constraints, std::span<double> values) {
  for (const auto& c : constraints) set_node_value(values, c.node, c.free * node_value(values, c.node));
}

void impose(std::span<const NodeConstraint> constraints, std::span<double> values) {
  for (const auto& c : constraints)
    set_node_value(values, c.node, c.free * node_value(values, c.node) + c.prescribed);
}

void join(std::span<const NodeConstraint> first, std::span<const NodeConstraint> second,
          std::vector<NodeConstraint>& joined) {
  joined.clear();
  auto a = first.begin();
  auto b = second.begin();
  while (a != first.end() || b != second.end()) {
    if (b == second.end() || (a != first.end() && a->node < b->node)) {
      joined.push_back(*a++);
    } else if (a == first.end() || b->node < a->node) {
      joined.push_back(*b++);
    } else {
      // What `second` prescribes counts only where `first` leaves the node free.
      const auto free = intersect(a->free, b->free);
      const auto rest = a->free * b->prescribed;
      joined.push_back({a->node, free, a->prescribed + rest - free * rest});
      ++a, ++b;
    }
  }
}

}  // namespace evert
