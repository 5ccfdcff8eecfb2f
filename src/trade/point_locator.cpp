#include "evert/trade/point_locator.hpp"

#include "evert/elements/shape_functions.hpp"
#include "evert/math/dual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evert::trade {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double distance_to_box(const Vec3d& point, const Vec3d& lower, const Vec3d& upper) {
  Vec3d away{};
  for (std::size_t i = 0; i < 3; ++i) away[i] = std::max({lower[i] - point[i], 0.0, point[i] - upper[i]});
  return norm(away);
}

/// How far ξ is outside of the reference cell, in lengths of its edges.
double outside_reference(CellType type, const Vec3d& xi) {
  const double triangle = std::max({-xi[0], -xi[1], xi[0] + xi[1] - 1});
  switch (type) {
    case CellType::tet4:
    case CellType::tet10:
      return std::max({-xi[0], -xi[1], -xi[2], xi[0] + xi[1] + xi[2] - 1, 0.0});
    case CellType::wedge6:
      return std::max({triangle, 0.5 * (std::abs(xi[2]) - 1), 0.0});
    case CellType::hex8:
      break;
  }
  return std::max(0.5 * (std::max({std::abs(xi[0]), std::abs(xi[1]), std::abs(xi[2])}) - 1), 0.0);
}

Vec3d middle_of_reference(CellType type) {
  if (type == CellType::hex8) return {0, 0, 0};
  return type == CellType::wedge6 ? Vec3d{1.0 / 3, 1.0 / 3, 0} : Vec3d{0.25, 0.25, 0.25};
}

Vec3d mapped(CellType type, std::span<const Vec3d> corners, const Vec3d& xi) {
  const auto n = shape_functions<double>(type, xi);
  Vec3d x{};
  for (std::size_t a = 0; a < corners.size(); ++a) x += n[a] * corners[a];
  return x;
}

/// ∂X/∂ξ
Mat3d jacobian(CellType type, std::span<const Vec3d> corners, const Vec3d& xi) {
  Mat3d j{};
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3<Dual<double>> moving{{xi[0], xi[1], xi[2]}};
    moving[k].derivative = 1;
    const auto n = shape_functions<Dual<double>>(type, moving);
    for (std::size_t a = 0; a < corners.size(); ++a) j.column[k] += n[a].derivative * corners[a];
  }
  return j;
}

/// J⁻¹ r by Cramer's rule; 0 for a flat cell.
Vec3d solve(const Mat3d& j, const Vec3d& r) {
  const double det = dot(j.column[0], cross(j.column[1], j.column[2]));
  if (det == 0) return {};
  return {dot(r, cross(j.column[1], j.column[2])) / det, dot(j.column[0], cross(r, j.column[2])) / det,
          dot(j.column[0], cross(j.column[1], r)) / det};
}

/// Newton's method for X(ξ) = point; at once for cells with flat faces and edges.
Vec3d reference_point(CellType type, std::span<const Vec3d> corners, const Vec3d& point) {
  constexpr int most_iterations = 20;
  constexpr double small = 1e-12;
  Vec3d xi = middle_of_reference(type);
  for (int i = 0; i < most_iterations; ++i) {
    const auto change = solve(jacobian(type, corners, xi), point - mapped(type, corners, xi));
    xi += change;
    if (!(norm(change) > small) || norm(xi) > 100) break;
  }
  return xi;
}

}  // namespace

std::string body_of_region(const std::string& region) { return region.substr(0, region.find('.')); }

PointLocator::PointLocator(const DistributedMesh& mesh) : mesh_(mesh) {
  for (const auto& block : mesh.cells) {
    const auto body = body_of_region(mesh.regions[static_cast<std::size_t>(block.region)]);
    auto part = std::ranges::find(parts_, body, &Part::body);
    if (part == parts_.end())
      part = parts_.insert(parts_.end(), Part{.body = body, .cells = {}, .cells_of_bin = {}});
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    for (std::size_t c = 0; c < block.global_ids.size(); ++c) {
      Cell cell{.type = block.type, .nodes = block.nodes.data() + stride * c};
      cell.lower = {infinity, infinity, infinity};
      cell.upper = -cell.lower;
      for (std::size_t a = 0; a < stride; ++a)
        for (std::size_t i = 0; i < 3; ++i) {
          const double x = mesh.rest_positions[static_cast<std::size_t>(cell.nodes[a])][i];
          cell.lower[i] = std::min(cell.lower[i], x);
          cell.upper[i] = std::max(cell.upper[i], x);
        }
      part->cells.push_back(cell);
    }
  }
  for (auto& part : parts_) fill_bins(part);
}

void PointLocator::fill_bins(Part& part) const {
  if (part.cells.empty()) return;
  part.lower = {infinity, infinity, infinity};
  part.upper = -part.lower;
  for (const auto& cell : part.cells)
    for (std::size_t i = 0; i < 3; ++i) {
      part.lower[i] = std::min(part.lower[i], cell.lower[i]);
      part.upper[i] = std::max(part.upper[i], cell.upper[i]);
    }
  const int most = std::clamp(static_cast<int>(std::cbrt(part.cells.size())), 1, 64);
  part.bins = {most, most, most};
  part.cells_of_bin.resize(static_cast<std::size_t>(most) * most * most);
  const auto range = [&](const Cell& cell, std::size_t i) {
    const double width = (part.upper[i] - part.lower[i]) / most;
    const auto bin = [&](double x) {
      return width > 0 ? std::clamp(static_cast<int>((x - part.lower[i]) / width), 0, most - 1) : 0;
    };
    const double margin = 1e-9 * (part.upper[i] - part.lower[i]);
    return std::array{bin(cell.lower[i] - margin), bin(cell.upper[i] + margin)};
  };
  for (std::size_t c = 0; c < part.cells.size(); ++c) {
    const auto x = range(part.cells[c], 0), y = range(part.cells[c], 1), z = range(part.cells[c], 2);
    for (int k = z[0]; k <= z[1]; ++k)
      for (int j = y[0]; j <= y[1]; ++j)
        for (int i = x[0]; i <= x[1]; ++i)
          part.cells_of_bin[static_cast<std::size_t>((k * most + j) * most + i)].push_back(c);
  }
}

PointLocator::Place PointLocator::place_in(const Cell& cell, const Vec3d& point) const {
  const auto stride = static_cast<std::size_t>(node_count(cell.type));
  std::array<Vec3d, most_nodes> corners{};
  Place place{.outside = 0, .count = stride};
  for (std::size_t a = 0; a < stride; ++a) {
    place.nodes[a] = cell.nodes[a];
    corners[a] = mesh_.rest_positions[static_cast<std::size_t>(cell.nodes[a])];
  }
  const auto of_cell = std::span(corners).first(stride);
  const auto xi = reference_point(cell.type, of_cell, point);
  const double outside = outside_reference(cell.type, xi);
  constexpr double farthest = 0.5;
  if (outside <= farthest) {
    place.weights = shape_functions<double>(cell.type, xi);
    place.outside = outside * norm(cell.upper - cell.lower);
    return place;
  }
  const auto nearest =
      std::ranges::min_element(of_cell, {}, [&](const Vec3d& corner) { return norm(corner - point); });
  place.weights[static_cast<std::size_t>(nearest - of_cell.begin())] = 1;
  place.outside = norm(*nearest - point);
  return place;
}

PointLocator::Place PointLocator::locate(const BodyPoint& point) const {
  Place best{.outside = infinity};
  const auto part = std::ranges::find(parts_, point.body, &Part::body);
  if (part == parts_.end() || part->cells.empty()) return best;
  const auto consider = [&](const Cell& cell) {
    const auto place = place_in(cell, point.position);
    if (place.outside < best.outside) best = place;
  };
  std::size_t bin = 0;
  for (std::size_t i = 3; i-- > 0;) {
    const double share = (point.position[i] - part->lower[i]) / (part->upper[i] - part->lower[i]);
    const double most = part->bins[i];
    const double at = std::isfinite(share) ? std::clamp(share * most, 0.0, most - 1) : 0;
    bin = bin * static_cast<std::size_t>(most) + static_cast<std::size_t>(at);
  }
  for (const auto c : part->cells_of_bin[bin])
    if (distance_to_box(point.position, part->cells[c].lower, part->cells[c].upper) < best.outside)
      consider(part->cells[c]);
  if (best.outside == 0) return best;
  for (const auto& cell : part->cells)
    if (distance_to_box(point.position, cell.lower, cell.upper) < best.outside) consider(cell);
  return best;
}

}  // namespace evert::trade
