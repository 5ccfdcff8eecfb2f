#include "evert/elements/shape_functions.hpp"

#include "evert/math/dual.hpp"
#include "evert/mesh/cell_geometry.hpp"

#include <cmath>
#include <span>

namespace evert {
namespace {

template <class T>
using ShapeValues = std::array<T, most_nodes>;

template <class T>
std::array<T, 4> barycentric(const Vec3<T>& xi) {
  return {T(1.0) - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
}

template <class T>
ShapeValues<T> linear_tet(const Vec3<T>& xi) {
  ShapeValues<T> n{};
  const auto l = barycentric(xi);
  for (std::size_t a = 0; a < 4; ++a) n[a] = l[a];
  return n;
}

template <class T>
ShapeValues<T> quadratic_tet(const Vec3<T>& xi) {
  ShapeValues<T> n{};
  const auto l = barycentric(xi);
  for (std::size_t a = 0; a < 4; ++a) n[a] = l[a] * (T(2.0) * l[a] - T(1.0));
  for (std::size_t e = 0; e < 6; ++e) n[4 + e] = T(4.0) * l[edges_of_tet[e][0]] * l[edges_of_tet[e][1]];
  return n;
}

template <class T>
ShapeValues<T> trilinear_hex(const Vec3<T>& xi) {
  // Which side of each axis a corner is at, VTK's order.
  constexpr std::array<std::array<double, 3>, 8> corners{
      {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
  ShapeValues<T> n{};
  for (std::size_t a = 0; a < 8; ++a) {
    n[a] = T(0.125);
    for (std::size_t k = 0; k < 3; ++k) n[a] *= T(1.0) + T(corners[a][k]) * xi[k];
  }
  return n;
}

template <class T>
ShapeValues<T> linear_wedge(const Vec3<T>& xi) {
  ShapeValues<T> n{};
  const std::array<T, 3> in_triangle{T(1.0) - xi[0] - xi[1], xi[0], xi[1]};
  for (std::size_t a = 0; a < 6; ++a)
    n[a] = T(0.5) * in_triangle[a % 3] * (T(1.0) + T(a < 3 ? -1.0 : 1.0) * xi[2]);
  return n;
}

/// Of the interval from 0 to 1.
struct LinePoint {
  double at, weight;
};

/// Gauss-Legendre: exact to the fifth degree.
std::vector<LinePoint> three_points() {
  const double off = 0.5 * std::sqrt(0.6);
  return {{0.5 - off, 5.0 / 18}, {0.5, 4.0 / 9}, {0.5 + off, 5.0 / 18}};
}

/// The same, exact to the ninth degree.
std::vector<LinePoint> five_points() {
  const double spread = 2 * std::sqrt(10.0 / 7), root = 13 * std::sqrt(70.0);
  const double near = std::sqrt(5 - spread) / 6, far = std::sqrt(5 + spread) / 6;
  const double of_near = (322 + root) / 1800, of_far = (322 - root) / 1800;
  return {{0.5 - far, of_far},
          {0.5 - near, of_near},
          {0.5, 64.0 / 225},
          {0.5 + near, of_near},
          {0.5 + far, of_far}};
}

/// A point of the unit cube, brought into the reference cell. The two corners of a triangle and the faces of
/// a tetrahedron are edges and faces of the cube that have collapsed, which costs one and two degrees.
struct CubePoint {
  Vec3d xi;
  double weight;
};

CubePoint into_cell(CellType type, double u, double v, double w, double weight) {
  switch (type) {
    case CellType::hex8:
      return {{2 * u - 1, 2 * v - 1, 2 * w - 1}, 8 * weight};
    case CellType::wedge6:
      return {{u, v * (1 - u), 2 * w - 1}, 2 * (1 - u) * weight};
    case CellType::tet4:
    case CellType::tet10:
      break;
  }
  return {{u, v * (1 - u), w * (1 - u) * (1 - v)}, (1 - u) * (1 - u) * (1 - v) * weight};
}

ShapeQuadrature::Point shape_point(CellType type, const CubePoint& point) {
  ShapeQuadrature::Point shape{
      .weight = point.weight, .values = shape_functions(type, point.xi), .gradients = {}};
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3<Dual<double>> along{{point.xi[0], point.xi[1], point.xi[2]}};
    along[k].derivative = 1;
    const auto values = shape_functions(type, along);
    for (std::size_t a = 0; a < most_nodes; ++a) shape.gradients[a][k] = values[a].derivative;
  }
  return shape;
}

}  // namespace

template <class T>
std::array<T, most_nodes> shape_functions(CellType type, const Vec3<T>& xi) {
  switch (type) {
    case CellType::tet4:
      return linear_tet(xi);
    case CellType::hex8:
      return trilinear_hex(xi);
    case CellType::wedge6:
      return linear_wedge(xi);
    case CellType::tet10:
      break;
  }
  return quadratic_tet(xi);
}

template std::array<double, most_nodes> shape_functions(CellType, const Vec3<double>&);
template std::array<Dual<double>, most_nodes> shape_functions(CellType, const Vec3<Dual<double>>&);

/// Degrees of N_a N_b |∂X/∂ξ|: 2 in tet4, 4 along each axis of hex8, 3 in the triangle and 4 along the axis
/// of wedge6, 4 + 3 in a tet10 with curved edges.
ShapeQuadrature mass_quadrature(CellType type) {
  ShapeQuadrature rule{.nodes = static_cast<std::size_t>(node_count(type)), .points = {}};
  const auto line = type == CellType::tet10 ? five_points() : three_points();
  for (const auto& u : line)
    for (const auto& v : line)
      for (const auto& w : line)
        rule.points.push_back(
            shape_point(type, into_cell(type, u.at, v.at, w.at, u.weight * v.weight * w.weight)));
  return rule;
}

}  // namespace evert
