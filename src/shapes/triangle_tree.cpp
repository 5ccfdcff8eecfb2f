#include "evert/shapes/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace evert {
namespace {

constexpr std::size_t leaf_size = 4;

/// The part of a triangle nearest to a point, as weights of the corners.  C. Ericson, Real-Time Collision
/// Detection (2005), 5.1.5
std::array<double, 3> nearest_weights(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& x) {
  const auto ab = b - a, ac = c - a;
  const double d1 = dot(ab, x - a), d2 = dot(ac, x - a);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = dot(ab, x - b), d4 = dot(ac, x - b);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double d5 = dot(ab, x - c), d6 = dot(ac, x - c);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4, along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
  if (va <= 0 && d4 >= d3 && d5 >= d6) return {0, 1 - along, along};
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

}  // namespace

double squared_distance(const Box3& box, const Vec3d& x) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double beyond = std::max({box.lower[k] - x[k], x[k] - box.upper[k], 0.0});
    sum += beyond * beyond;
  }
  return sum;
}

TriangleTree::TriangleTree(TriangleSurface surface)
    : surface_(std::move(surface)), order_(surface_.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(order_.size());
  build(0, order_.size());
}

Box3 TriangleTree::box_of(std::size_t triangle) const {
  Box3 box;
  for (std::size_t k = 0; k < 3; ++k) box.include(corner(triangle, k));
  return box;
}

/// Splits at the median along the longest side of the middles' box.
void TriangleTree::build(std::size_t first, std::size_t end) {
  const auto at = nodes_.size();
  nodes_.emplace_back();
  Box3 box, middles;
  const auto middle_of = [this](std::size_t t) {
    const auto own = box_of(t);
    return 0.5 * (own.lower + own.upper);
  };
  for (std::size_t i = first; i < end; ++i) {
    const auto own = box_of(order_[i]);
    box.include(own.lower);
    box.include(own.upper);
    middles.include(middle_of(order_[i]));
  }
  nodes_[at].box = box;
  if (end - first <= leaf_size) {
    nodes_[at].first = first;
    nodes_[at].count = end - first;
    return;
  }
  const auto size = middles.upper - middles.lower;
  const std::size_t axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
  const auto half = first + (end - first) / 2;
  const auto place = [this](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(place(first), place(half), place(end),
                   [&](std::size_t a, std::size_t b) { return middle_of(a)[axis] < middle_of(b)[axis]; });
  build(first, half);
  nodes_[at].second = nodes_.size();
  build(half, end);
}

NearestPart TriangleTree::on_triangle(std::size_t triangle, const Vec3d& x) const {
  const auto &a = corner(triangle, 0), &b = corner(triangle, 1), &c = corner(triangle, 2);
  const auto weight = nearest_weights(a, b, c, x);
  if (weight[0] != 0 && weight[1] != 0 && weight[2] != 0) {
    // by the plane, for the weights of a thin triangle have lost digits
    const auto across = cross(b - a, c - a);
    const double height = dot(x - a, across) / dot(across, across);
    return {height * height * dot(across, across), x - height * across, triangle};
  }
  const auto point = weight[0] * a + weight[1] * b + weight[2] * c;
  NearestPart found{dot(x - point, x - point), point, triangle};
  const auto is_off = [&](std::size_t k) { return weight[k] == 0; };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
    if (is_off(next) && is_off(last))
      found.corner = static_cast<std::int8_t>(k);
    else if (is_off(last) && !is_off(k) && !is_off(next))
      found.edge = static_cast<std::int8_t>(k);
  }
  return found;
}

NearestPart TriangleTree::nearest(const Vec3d& x) const {
  NearestPart best{HUGE_VAL, {}, 0};
  struct Waiting {
    std::size_t node;
    double squared;
  };
  constexpr std::size_t deepest = 64;  // the tree is balanced: 31 levels at most
  std::array<Waiting, deepest> waiting;
  std::size_t count = 0;
  waiting[count++] = {0, squared_distance(nodes_[0].box, x)};
  while (count > 0) {
    const auto [at, squared] = waiting[--count];
    if (squared >= best.squared) continue;
    const auto& node = nodes_[at];
    if (node.count > 0) {
      for (std::size_t i = node.first; i < node.first + node.count; ++i) {
        const auto found = on_triangle(order_[i], x);
        if (found.squared < best.squared) best = found;
      }
      continue;
    }
    Waiting near{at + 1, squared_distance(nodes_[at + 1].box, x)};
    Waiting far{node.second, squared_distance(nodes_[node.second].box, x)};
    if (far.squared < near.squared) std::swap(near, far);
    waiting[count++] = far;
    waiting[count++] = near;
  }
  return best;
}

}  // namespace evert
