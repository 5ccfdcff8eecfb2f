#include "evert/io/surface.hpp"

#include "evert/mesh/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace evert {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// A face in triangles, by places in BoundaryFace::nodes.
std::span<const Triangle> triangles_of(const BoundaryFace& face) {
  static constexpr std::array<Triangle, 1> triangle{{{0, 1, 2}}};
  static constexpr std::array<Triangle, 2> quadrilateral{{{0, 1, 2}, {0, 2, 3}}};
  static constexpr std::array<Triangle, 4> quadratic{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  if (face.node_count == 6) return quadratic;
  if (face.corners == 4) return quadrilateral;
  return triangle;
}

template <class T>
void sort_and_unite(std::vector<T>& values) {
  std::ranges::sort(values);
  values.erase(std::ranges::unique(values).begin(), values.end());
}

double area_of(const Surface& surface, std::span<const Vec3d> positions) {
  const auto at = [&](std::uint32_t vertex) {
    return positions[static_cast<std::size_t>(surface.nodes[vertex])];
  };
  double area = 0;
  for (const auto& [a, b, c] : surface.triangles) area += norm(cross(at(b) - at(a), at(c) - at(a))) / 2;
  return area;
}

/// The box of a grid, and the region, that a vertex lies in.
using Box = std::array<std::int64_t, 4>;

std::vector<Box> boxes_of(const Surface& surface, std::span<const Vec3d> positions, double size) {
  const auto [lower, upper] = bounds_of(positions);
  std::vector<Box> boxes;
  boxes.reserve(surface.nodes.size());
  for (std::size_t v = 0; v < surface.nodes.size(); ++v) {
    const auto above = positions[static_cast<std::size_t>(surface.nodes[v])] - lower;
    Box box{surface.regions[v]};
    for (std::size_t c = 0; c < 3; ++c) box[c + 1] = static_cast<std::int64_t>(above[c] / size);
    boxes.push_back(box);
  }
  return boxes;
}

/// For each vertex the vertex that stands for all of its box: the one nearest to their mean.
std::vector<std::uint32_t> representatives(const Surface& surface, std::span<const Vec3d> positions,
                                           double size) {
  const auto boxes = boxes_of(surface, positions, size);
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::uint32_t v) { return std::pair(boxes[v], v); });

  std::vector<std::uint32_t> chosen(boxes.size());
  const auto at = [&](std::uint32_t v) { return positions[static_cast<std::size_t>(surface.nodes[v])]; };
  for (auto first = order.begin(); first != order.end();) {
    const auto last =
        std::find_if(first, order.end(), [&](std::uint32_t v) { return boxes[v] != boxes[*first]; });
    Vec3d mean{};
    for (auto v = first; v != last; ++v) mean += at(*v);
    mean = mean * (1 / static_cast<double>(last - first));
    const auto nearest =
        *std::ranges::min_element(first, last, {}, [&](auto v) { return norm(at(v) - mean); });
    for (; first != last; ++first) chosen[*first] = nearest;
  }
  return chosen;
}

/// The triangle begun at its smallest vertex: equal ones become equal arrays.
Triangle rotated(Triangle triangle) {
  std::ranges::rotate(triangle, std::ranges::min_element(triangle));
  return triangle;
}

/// The surface with each vertex replaced, without what that collapses.
Surface replaced(const Surface& surface, std::span<const std::uint32_t> by) {
  Surface result;
  for (const auto& [a, b, c] : surface.triangles)
    if (by[a] != by[b] && by[b] != by[c] && by[c] != by[a])
      result.triangles.push_back(rotated({by[a], by[b], by[c]}));
  sort_and_unite(result.triangles);

  constexpr auto unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(surface.nodes.size(), unused);
  for (auto& triangle : result.triangles)
    for (auto& vertex : triangle) {
      if (number[vertex] == unused) {
        number[vertex] = static_cast<std::uint32_t>(result.nodes.size());
        result.nodes.push_back(surface.nodes[vertex]);
        result.regions.push_back(surface.regions[vertex]);
      }
      vertex = number[vertex];
    }
  for (const auto& [vertex, cell] : surface.touches)
    if (number[by[vertex]] != unused) result.touches.push_back({number[by[vertex]], cell});
  sort_and_unite(result.touches);
  return result;
}

}  // namespace

std::pair<Vec3d, Vec3d> bounds_of(std::span<const Vec3d> positions) {
  constexpr double far = std::numeric_limits<double>::infinity();
  std::pair<Vec3d, Vec3d> bounds{{far, far, far}, {-far, -far, -far}};
  for (const auto& position : positions)
    for (std::size_t c = 0; c < 3; ++c) {
      bounds.first[c] = std::min(bounds.first[c], position[c]);
      bounds.second[c] = std::max(bounds.second[c], position[c]);
    }
  return bounds;
}

Surface surface_of(const Mesh& mesh) {
  constexpr auto inside = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> vertex_of(mesh.nodes.size(), inside);
  Surface surface;
  for (const auto& face : boundary_faces(mesh)) {
    std::array<std::uint32_t, 6> vertices{};
    for (std::size_t i = 0; i < face.used().size(); ++i) {
      auto& vertex = vertex_of[static_cast<std::size_t>(face.nodes[i])];
      if (vertex == inside) {
        vertex = static_cast<std::uint32_t>(surface.nodes.size());
        surface.nodes.push_back(face.nodes[i]);
      }
      vertices[i] = vertex;
    }
    for (const auto& [a, b, c] : triangles_of(face))
      surface.triangles.push_back({vertices[a], vertices[b], vertices[c]});
  }
  surface.regions.resize(surface.nodes.size());
  GlobalIndex first_cell = 0;
  for (const auto& block : mesh.cells) {
    for (std::size_t i = 0; i < block.nodes.size(); ++i) {
      const auto vertex = vertex_of[static_cast<std::size_t>(block.nodes[i])];
      if (vertex == inside) continue;
      const auto cell = i / static_cast<std::size_t>(node_count(block.type));
      surface.touches.push_back({vertex, first_cell + static_cast<GlobalIndex>(cell)});
      surface.regions[vertex] = block.region[cell];
    }
    first_cell += block.size();
  }
  std::ranges::sort(surface.touches);
  return surface;
}

Surface simplified(const Surface& surface, std::span<const Vec3d> positions, std::size_t max_triangles) {
  if (surface.triangles.size() <= max_triangles) return surface;
  // A box that the surface crosses squarely makes 2 triangles; what is thinner than that needs larger boxes.
  const auto [lower, upper] = bounds_of(positions);
  const double squarely = std::sqrt(2 * area_of(surface, positions) / static_cast<double>(max_triangles));
  double size = std::max({squarely, 1e-6 * norm(upper - lower), std::numeric_limits<double>::min()});
  for (;; size *= 1.15) {
    auto smaller = replaced(surface, representatives(surface, positions, size));
    if (smaller.triangles.size() <= max_triangles) return smaller;
  }
}

std::vector<double> smallest_at_vertices(const Surface& surface, std::span<const double> per_cell) {
  std::vector<double> smallest(surface.nodes.size(), std::numeric_limits<double>::infinity());
  for (const auto& [vertex, cell] : surface.touches)
    smallest[vertex] = std::min(smallest[vertex], per_cell[static_cast<std::size_t>(cell)]);
  return smallest;
}

}  // namespace evert
