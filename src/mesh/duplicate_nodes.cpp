#include "duplicate_nodes.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace evert {
namespace {

/// A box of a grid twice as wide as the tolerance, so that the neighbourhood of a point touches at most
/// eight.
using Box = std::array<std::int64_t, 3>;

struct BoxHash {
  std::size_t operator()(const Box& box) const {
    std::uint64_t hash = 0;
    for (const auto i : box) hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9E3779B97F4A7C15ULL;
    return hash ^ (hash >> 32U);
  }
};

Box box_of(const Vec3d& offset, double width) {
  Box box{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    box[axis] = static_cast<std::int64_t>(std::floor(offset[axis] / width));
  return box;
}

}  // namespace

GlobalIndex count_duplicate_nodes(std::span<const Vec3d> points, double tolerance) {
  if (points.empty()) return 0;
  if (!(tolerance > 0)) return static_cast<GlobalIndex>(points.size()) - 1;  // a box without size
  const double width = 2 * tolerance;
  const auto origin = points.front();  // keeps box numbers small, however far away the mesh is
  std::unordered_map<Box, std::vector<Vec3d>, BoxHash> kept;
  kept.reserve(points.size());
  const auto has_twin = [&](const Vec3d& point) {
    const auto low = box_of(point - Vec3d{tolerance, tolerance, tolerance}, width);
    const auto high = box_of(point + Vec3d{tolerance, tolerance, tolerance}, width);
    for (auto i = low[0]; i <= high[0]; ++i)
      for (auto j = low[1]; j <= high[1]; ++j)
        for (auto k = low[2]; k <= high[2]; ++k) {
          const auto found = kept.find({i, j, k});
          if (found == kept.end()) continue;
          for (const auto& other : found->second) {
            const auto apart = point - other;
            if (dot(apart, apart) <= tolerance * tolerance) return true;
          }
        }
    return false;
  };
  GlobalIndex duplicates = 0;
  for (const auto& position : points) {
    const auto point = position - origin;
    if (has_twin(point)) {
      ++duplicates;
    } else {
      kept[box_of(point, width)].push_back(point);
    }
  }
  return duplicates;
}

}  // namespace evert
