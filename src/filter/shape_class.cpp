#include "evert/filter/shape_class.hpp"

#include "evert/math/eigen_symmetric3.hpp"
#include "evert/mesh/cell_geometry.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstddef>

namespace evert {
namespace {

// Extents differ by more than five times.
constexpr double much_smaller = 0.04;

struct Tetrahedron {
  std::array<Vec3d, 4> gradients{};
  Vec3d gamma{};        ///< descending
  Vec3d shortest_axis;  ///< eigenvector of gamma[0]
  std::array<double, 6> edges{};

  explicit Tetrahedron(std::span<const Vec3d, 4> corners) {
    const Mat3d to_reference =
        inverse(Mat3d{corners[1] - corners[0], corners[2] - corners[0], corners[3] - corners[0]});
    Mat3d squares{};
    for (std::size_t a = 1; a < 4; ++a) {
      const Vec3d unit{a == 1 ? 1.0 : 0.0, a == 2 ? 1.0 : 0.0, a == 3 ? 1.0 : 0.0};
      gradients[a] = transpose_times(to_reference, unit);
      gradients[0] -= gradients[a];
    }
    for (const Vec3d& g : gradients) squares += outer(g, g);
    const auto eigen = eigen_symmetric3(squares);
    gamma = {eigen.values[2], eigen.values[1], eigen.values[0]};
    shortest_axis = eigen.vectors.column[2];
    for (std::size_t e = 0; e < 6; ++e)
      edges[e] = norm(corners[edges_of_tet[e][0]] - corners[edges_of_tet[e][1]]);
  }

  /// Of the size of the shortest extent, 1/√γ1.
  [[nodiscard]] bool is_short(std::size_t edge) const { return edges[edge] < 4 / std::sqrt(gamma[0]); }
};

bool short_edges_are_a_face(const Tetrahedron& tet) {
  std::bitset<4> corners;
  int count = 0;
  for (std::size_t e = 0; e < 6; ++e) {
    if (!tet.is_short(e)) continue;
    ++count;
    corners.set(edges_of_tet[e][0]);
    corners.set(edges_of_tet[e][1]);
  }
  return count == 3 && corners.count() == 3;
}

/// s_i: how corner i takes part in the shortest extent.
std::array<double, 4> heights_of(const Tetrahedron& tet) {
  std::array<double, 4> heights{};
  for (std::size_t a = 0; a < 4; ++a) heights[a] = dot(tet.shortest_axis, tet.gradients[a]);
  return heights;
}

/// One with a single short direction.
ShapeClass flat_class(const Tetrahedron& tet) {
  const auto heights = heights_of(tet);
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  std::ranges::sort(order, std::greater(), [&](std::size_t a) { return std::abs(heights[a]); });
  const auto shortest = static_cast<std::size_t>(std::ranges::min_element(tet.edges) - tet.edges.begin());
  const auto& ends = edges_of_tet[shortest];
  const bool joins_the_largest =
      (ends[0] == order[0] && ends[1] == order[1]) || (ends[0] == order[1] && ends[1] == order[0]);
  if (tet.is_short(shortest) && joins_the_largest && heights[ends[0]] * heights[ends[1]] < 0)
    return ShapeClass::wedge;
  const auto positive = std::ranges::count_if(heights, [](double s) { return s > 0; });
  return positive == 2 ? ShapeClass::sliver : ShapeClass::cap;
}

}  // namespace

std::string_view name_of(ShapeClass shape) {
  switch (shape) {
    case ShapeClass::well_shaped:
      return "well-shaped";
    case ShapeClass::needle:
      return "needle";
    case ShapeClass::spindle:
      return "spindle";
    case ShapeClass::wedge:
      return "wedge";
    case ShapeClass::cap:
      return "cap";
    case ShapeClass::sliver:
      break;
  }
  return "sliver";
}

ShortDistances short_distances(std::span<const Vec3d, 4> corners) {
  const Tetrahedron tet(corners);
  ShortDistances distances;
  switch (shape_class(corners)) {
    case ShapeClass::needle:
      for (std::size_t e = 0; e < 6; ++e)
        if (tet.is_short(e)) distances.edges.push_back(e);
      break;
    case ShapeClass::wedge:
      distances.edges.push_back(
          static_cast<std::size_t>(std::ranges::min_element(tet.edges) - tet.edges.begin()));
      break;
    case ShapeClass::cap: {  // the corner that is alone on its side
      const auto heights = heights_of(tet);
      const bool alone = std::ranges::count_if(heights, [](double s) { return s > 0; }) == 1;
      distances.apex = static_cast<std::size_t>(
          std::ranges::find_if(heights, [&](double s) { return (s > 0) == alone; }) - heights.begin());
      break;
    }
    default:
      distances.edges = {0, 1, 2, 3, 4, 5};
  }
  return distances;
}

ShapeClass shape_class(std::span<const Vec3d, 4> corners) {
  const Tetrahedron tet(corners);
  const auto extends = [&](std::size_t k) { return !(tet.gamma[k] > much_smaller * tet.gamma[0]); };
  if (!extends(1) && !extends(2)) return ShapeClass::well_shaped;
  if (!extends(1)) return short_edges_are_a_face(tet) ? ShapeClass::needle : ShapeClass::spindle;
  return flat_class(tet);
}

}  // namespace evert
