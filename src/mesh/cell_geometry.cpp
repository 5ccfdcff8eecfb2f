#include "evert/mesh/cell_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace evert {
namespace {

/// A quadrature point of a reference cell: its weight and the gradients of the shape functions there.
struct Point {
  double weight = 0;
  std::array<Vec3d, 10> gradients{};
};

std::vector<Point> tet4_points() { return {{1.0 / 6, {{{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}}}; }

/// 2×2×2 Gauss points of [-1,1]³.
std::vector<Point> hex8_points() {
  constexpr std::array<std::array<double, 3>, 8> corners{
      {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
  std::vector<Point> points;
  for (const auto& gauss : corners) {
    Point point{.weight = 1};
    for (std::size_t a = 0; a < 8; ++a) {
      std::array<double, 3> factor{};
      for (std::size_t i = 0; i < 3; ++i) factor[i] = 1 + corners[a][i] * gauss[i] / std::numbers::sqrt3;
      for (std::size_t i = 0; i < 3; ++i)
        point.gradients[a][i] = corners[a][i] * factor[(i + 1) % 3] * factor[(i + 2) % 3] / 8;
    }
    points.push_back(point);
  }
  return points;
}

/// Three points of the triangle times two Gauss points of [-1,1].
std::vector<Point> wedge6_points() {
  constexpr std::array<std::array<double, 3>, 3> barycentric{
      {{2.0 / 3, 1.0 / 6, 1.0 / 6}, {1.0 / 6, 2.0 / 3, 1.0 / 6}, {1.0 / 6, 1.0 / 6, 2.0 / 3}}};
  constexpr std::array<std::array<double, 2>, 3> slopes{{{-1, -1}, {1, 0}, {0, 1}}};
  std::vector<Point> points;
  for (const double t : {-1 / std::numbers::sqrt3, 1 / std::numbers::sqrt3})
    for (const auto& triangle : barycentric) {
      Point point{.weight = 1.0 / 6};
      for (std::size_t a = 0; a < 3; ++a) {
        const double bottom = (1 - t) / 2;
        const double top = (1 + t) / 2;
        point.gradients[a] = {slopes[a][0] * bottom, slopes[a][1] * bottom, -triangle[a] / 2};
        point.gradients[a + 3] = {slopes[a][0] * top, slopes[a][1] * top, triangle[a] / 2};
      }
      points.push_back(point);
    }
  return points;
}

/// The four points of degree 2.
std::vector<Point> tet10_points() {
  constexpr std::array<Vec3d, 4> slopes{{{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const double far = (5 + 3 * std::sqrt(5.0)) / 20;
  const double near = (5 - std::sqrt(5.0)) / 20;
  std::vector<Point> points;
  for (std::size_t q = 0; q < 4; ++q) {
    std::array<double, 4> barycentric{near, near, near, near};
    barycentric[q] = far;
    Point point{.weight = 1.0 / 24};
    for (std::size_t a = 0; a < 4; ++a) point.gradients[a] = (4 * barycentric[a] - 1) * slopes[a];
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [a, b] = edges_of_tet[e];
      point.gradients[4 + e] = 4.0 * (barycentric[a] * slopes[b] + barycentric[b] * slopes[a]);
    }
    points.push_back(point);
  }
  return points;
}

std::span<const Point> quadrature(CellType type) {
  static const std::array tables{tet4_points(), hex8_points(), wedge6_points(), tet10_points()};
  return tables[static_cast<std::size_t>(type)];
}

/// det ∂x/∂ξ of the cell scaled by `scale`.
double jacobian_determinant(const Point& point, std::span<const Vec3d> nodes, double scale = 1) {
  std::array<Vec3d, 3> columns{};
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t j = 0; j < 3; ++j) columns[j] += scale * point.gradients[a][j] * nodes[a];
  return dot(columns[0], cross(columns[1], columns[2]));
}

/// The corners joined to a corner by an edge: three in every type of cell.
using Neighbours = std::array<std::size_t, 3>;
constexpr std::array<Neighbours, 4> tet_neighbours{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
constexpr std::array<Neighbours, 6> wedge_neighbours{
    {{1, 2, 3}, {2, 0, 4}, {0, 1, 5}, {5, 4, 0}, {3, 5, 1}, {4, 3, 2}}};
constexpr std::array<Neighbours, 8> hex_neighbours{
    {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};

std::span<const Neighbours> neighbours_of(CellType type) {
  switch (type) {
    case CellType::tet4:
    case CellType::tet10:
      return tet_neighbours;
    case CellType::hex8:
      return hex_neighbours;
    case CellType::wedge6:
      return wedge_neighbours;
  }
  return {};
}

double norm(const Vec3d& a) { return std::sqrt(dot(a, a)); }

/// Angle between the planes through `axis` and a, and through `axis` and b [degrees].
double angle_about(const Vec3d& axis, const Vec3d& a, const Vec3d& b) {
  const auto normal_a = cross(axis, a);
  const auto normal_b = cross(axis, b);
  return std::atan2(norm(cross(normal_a, normal_b)), dot(normal_a, normal_b)) * 180 / std::numbers::pi;
}

}  // namespace

double cell_volume(CellType type, std::span<const Vec3d> nodes) {
  double volume = 0;
  for (const auto& point : quadrature(type)) volume += point.weight * jacobian_determinant(point, nodes);
  return volume;
}

JacobianRange jacobian_range(CellType type, std::span<const Vec3d> nodes) {
  const double longest = edge_range(type, nodes).longest;
  if (longest == 0) return {};
  JacobianRange range{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  for (const auto& point : quadrature(type)) {
    const double determinant = jacobian_determinant(point, nodes, 1 / longest);
    range.smallest = std::min(range.smallest, determinant);
    range.largest = std::max(range.largest, determinant);
  }
  return range;
}

EdgeRange edge_range(CellType type, std::span<const Vec3d> nodes) {
  EdgeRange range{std::numeric_limits<double>::max(), 0};
  const auto neighbours = neighbours_of(type);
  for (std::size_t corner = 0; corner < neighbours.size(); ++corner)
    for (const auto neighbour : neighbours[corner]) {
      const double length = norm(nodes[neighbour] - nodes[corner]);
      range.shortest = std::min(range.shortest, length);
      range.longest = std::max(range.longest, length);
    }
  return range;
}

double middle_offset(CellType type, std::span<const Vec3d> nodes) {
  if (type != CellType::tet10) return 0;
  double largest = 0;
  for (std::size_t e = 0; e < edges_of_tet.size(); ++e) {
    const Vec3d& a = nodes[edges_of_tet[e][0]];
    const Vec3d& b = nodes[edges_of_tet[e][1]];
    const double offset = norm(nodes[4 + e] - 0.5 * (a + b)) / norm(b - a);
    largest = std::max(largest, std::isnan(offset) ? std::numeric_limits<double>::infinity() : offset);
  }
  return largest;
}

void append_dihedral_angles(CellType type, std::span<const Vec3d> nodes, std::vector<double>& angles) {
  const auto neighbours = neighbours_of(type);
  for (std::size_t corner = 0; corner < neighbours.size(); ++corner) {
    std::array<Vec3d, 3> edges{};
    for (std::size_t i = 0; i < 3; ++i) edges[i] = nodes[neighbours[corner][i]] - nodes[corner];
    for (std::size_t i = 0; i < 3; ++i)
      angles.push_back(angle_about(edges[i], edges[(i + 1) % 3], edges[(i + 2) % 3]));
  }
}

}  // namespace evert
