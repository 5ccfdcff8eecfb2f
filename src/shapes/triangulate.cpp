#include "evert/core/error.hpp"
#include "evert/math/eigen_symmetric3.hpp"
#include "evert/shapes/implicit_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace evert {
namespace {

/// Dual contouring (Ju, Losasso, Schaefer, Warren 2002, Dual contouring of Hermite data) on a grid over the
/// solid's box: a point in every cell that the surface passes through, at the place that fits best to the
/// tangent planes where the surface crosses the cell's edges; a quadrilateral between the four cells at
/// every crossed edge.
class Contour {
 public:
  Contour(const ImplicitSurface& solid, const Box3& box, int cells) : solid_(solid) {
    const auto size = box.upper - box.lower;
    const double longest = std::max({size[0], size[1], size[2]});
    constexpr int fewest = 8;
    for (std::size_t k = 0; k < 3; ++k) {
      const int inside = std::max(fewest, static_cast<int>(std::ceil(cells * size[k] / longest)));
      // the margin lets the surface lie inside the grid; not a whole cell, so that flat sides miss the points
      step_[k] = size[k] / (inside - 0.37);
      lower_[k] = box.lower[k] - 1.185 * step_[k];
      count_[k] = inside + 3;  // points, one more than cells
    }
  }

  TriangleSurface run() {
    sample();
    cell_point_.assign(phi_.size(), -1);
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 1; k < count_[2] - 1; ++k)
        for (int j = 1; j < count_[1] - 1; ++j)
          for (int i = 1; i < count_[0] - 1; ++i) cover_edge({i, j, k}, static_cast<std::size_t>(axis));
    return std::move(surface_);
  }

 private:
  using Index = std::array<int, 3>;

  [[nodiscard]] std::size_t number(const Index& at) const {
    return (static_cast<std::size_t>(at[2]) * static_cast<std::size_t>(count_[1]) +
            static_cast<std::size_t>(at[1])) *
               static_cast<std::size_t>(count_[0]) +
           static_cast<std::size_t>(at[0]);
  }
  [[nodiscard]] Vec3d position(const Index& at) const {
    Vec3d x = lower_;
    for (std::size_t k = 0; k < 3; ++k) x[k] += at[k] * step_[k];
    return x;
  }
  [[nodiscard]] bool is_inside(const Index& at) const { return phi_[number(at)] < 0; }

  void sample() {
    phi_.reserve(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                 static_cast<std::size_t>(count_[2]));
    for (int k = 0; k < count_[2]; ++k)
      for (int j = 0; j < count_[1]; ++j)
        for (int i = 0; i < count_[0]; ++i) phi_.push_back(solid_.signed_distance(position({i, j, k})));
  }

  /// Between two points of the grid, one inside and one outside.
  [[nodiscard]] Vec3d crossing(const Index& from, const Index& to) const {
    auto inside = position(is_inside(from) ? from : to), outside = position(is_inside(from) ? to : from);
    constexpr int halvings = 40;
    for (int n = 0; n < halvings; ++n) {
      const auto middle = 0.5 * (inside + outside);
      (solid_.signed_distance(middle) < 0 ? inside : outside) = middle;
    }
    return 0.5 * (inside + outside);
  }

  /// The quadrilateral around the edge from `at` along `axis`, where the surface crosses it.
  void cover_edge(const Index& at, std::size_t axis) {
    auto next = at;
    ++next[axis];
    if (is_inside(at) == is_inside(next)) return;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<std::int32_t, 4> corner{};
    constexpr std::array<std::array<int, 2>, 4> around{{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};
    for (std::size_t c = 0; c < 4; ++c) {
      auto cell = at;
      cell[u] += around[c][0];
      cell[v] += around[c][1];
      corner[c] = point_of(cell);
    }
    if (!is_inside(at)) std::swap(corner[1], corner[3]);
    surface_.triangles.push_back({corner[0], corner[1], corner[2]});
    surface_.triangles.push_back({corner[0], corner[2], corner[3]});
  }

  /// The number of the point in a cell.
  [[nodiscard]] std::int32_t point_of(const Index& cell) {
    auto& point = cell_point_[number(cell)];
    if (point < 0) {
      point = static_cast<std::int32_t>(surface_.points.size());
      surface_.points.push_back(best_point(cell));
    }
    return point;
  }

  /// Minimises the sum of squared distances to the tangent planes, in units of the cell. Directions in which
  /// they say little keep the mean of the crossings.
  [[nodiscard]] Vec3d best_point(const Index& cell) const {
    std::array<Vec3d, 12> points{}, normals{};
    std::size_t found = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 4; ++side) {
        auto from = cell;
        from[(axis + 1) % 3] += side & 1;
        from[(axis + 2) % 3] += side >> 1;
        auto to = from;
        ++to[axis];
        if (is_inside(from) == is_inside(to)) continue;
        points[found] = crossing(from, to);
        normals[found] = solid_.normal(points[found]);
        ++found;
      }
    Vec3d mean{};
    for (std::size_t n = 0; n < found; ++n) mean += (1 / static_cast<double>(found)) * points[n];
    Mat3d a{};
    Vec3d b{};
    for (std::size_t n = 0; n < found; ++n) {
      Vec3d normal{};
      for (std::size_t k = 0; k < 3; ++k) normal[k] = normals[n][k] * step_[k];
      normal = (1 / norm(normal)) * normal;
      Vec3d way{};
      for (std::size_t k = 0; k < 3; ++k) way[k] = (points[n][k] - mean[k]) / step_[k];
      a += outer(normal, normal);
      b += dot(normal, way) * normal;
    }
    const auto eigen = eigen_symmetric3(a);
    const auto lowest = position(cell);
    Vec3d shift{};
    for (std::size_t k = 0; k < 3; ++k)
      if (eigen.values[k] > 0.05 * eigen.values[2])
        shift += (dot(eigen.vectors.column[k], b) / eigen.values[k]) * eigen.vectors.column[k];
    for (std::size_t k = 0; k < 3; ++k)
      mean[k] = std::clamp(mean[k] + shift[k] * step_[k], lowest[k], lowest[k] + step_[k]);
    return mean;
  }

  const ImplicitSurface& solid_;
  Vec3d lower_{}, step_{};
  std::array<int, 3> count_{};
  std::vector<double> phi_;               // at the points of the grid
  std::vector<std::int32_t> cell_point_;  // by the lowest point of the cell, −1 until there is one
  TriangleSurface surface_;
};

}  // namespace

TriangleSurface triangulate(const ImplicitSurface& solid, const Fineness& fineness) {
  if (auto own = solid.own_triangles(fineness)) return std::move(*own);
  auto box = solid.bounds();
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_empty = !(box.lower[k] < box.upper[k]);
    if (is_empty) throw UserError("nothing is inside the shape: it has no surface");
    if (!std::isfinite(box.lower[k])) box.lower[k] = -fineness.extent / 2;
    if (!std::isfinite(box.upper[k])) box.upper[k] = fineness.extent / 2;
  }
  return Contour(solid, box, fineness.cells).run();
}

}  // namespace evert
