#include "fibres.hpp"

#include "evert/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

namespace evert {
namespace {

/// Of length 1, or 0. Squares of what files hold may overflow or vanish: scaled first.
Vec3d unit_vector(const Vec3d& v) {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (!(largest > 0)) return {};
  const Vec3d scaled{v[0] / largest, v[1] / largest, v[2] / largest};
  return (1 / norm(scaled)) * scaled;
}

double distance_to_segment(const Vec3d& point, const Vec3d& from, const Vec3d& to) {
  const Vec3d along = to - from;
  const double share = std::clamp(dot(point - from, along) / dot(along, along), 0.0, 1.0);
  return norm(point - (from + share * along));
}

/// Of the segment nearest to the point, the first of several.
Vec3d direction_along(std::span<const Vec3d> curve, const Vec3d& point) {
  double nearest = std::numeric_limits<double>::infinity();
  Vec3d direction{};
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const double distance = distance_to_segment(point, curve[i - 1], curve[i]);
    if (!(distance < nearest)) continue;
    nearest = distance;
    direction = curve[i] - curve[i - 1];
  }
  return unit_vector(direction);
}

Vec3d centre_of(const Mesh& mesh, const CellBlock& block, std::size_t cell) {
  const auto count = static_cast<std::size_t>(node_count(block.type));
  Vec3d sum{};
  for (const auto node : std::span(block.nodes).subspan(cell * count, count))
    sum += mesh.nodes[static_cast<std::size_t>(node)];
  return (1.0 / static_cast<double>(count)) * sum;
}

Vec3d direction_of(const FibreConfig& fibres, const Mesh& mesh, const CellBlock& block, std::size_t cell) {
  if (const auto* constant = std::get_if<ConstantFibres>(&fibres)) return constant->direction;
  if (const auto* curve = std::get_if<CurveFibres>(&fibres))
    return direction_along(curve->curve, centre_of(mesh, block, cell));
  return unit_vector(block.vectors[cell]);
}

}  // namespace

void set_fibre_directions(Mesh& mesh, const BodyConfig& body, const std::vector<bool>& with_fibres) {
  GlobalIndex needing = 0, missing = 0, first_missing = 0, number = 0;
  for (auto& block : mesh.cells) {
    std::vector<Vec3d> directions(block.region.size(), Vec3d{});
    for (std::size_t cell = 0; cell < directions.size(); ++cell, ++number) {
      if (!with_fibres[static_cast<std::size_t>(block.region[cell])]) continue;
      directions[cell] = direction_of(*body.fibres, mesh, block, cell);
      ++needing;
      if (norm(directions[cell]) > 0) continue;
      if (missing++ == 0) first_missing = number;
    }
    block.vectors = std::move(directions);
  }
  if (missing > 0)
    throw UserError("bodies." + body.name + ".fibres.field: '" + std::get<FieldFibres>(*body.fibres).field +
                    "' is zero or missing in " + std::to_string(missing) + " of " + std::to_string(needing) +
                    " cells that have fibres (the first is cell " + std::to_string(first_missing) +
                    ", counted from 0); each of them needs a direction");
}

}  // namespace evert
