#pragma once
#include "evert/mesh/mesh.hpp"

#include <cstdint>
#include <random>

namespace evert {

/// The same numbers from the same seed with every library.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}
  /// In [low, high).
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
  }
  /// In [0, count).
  std::size_t below(std::size_t count) { return engine_() % count; }

 private:
  std::mt19937_64 engine_;
};

/// Moves every node that is not on the surface by up to `amount` [m] along each axis, by less or not at all
/// where a tetrahedron would lose more than half of its volume.
void shake_inner_nodes(Mesh& mesh, double amount, RandomNumbers& random);

/// How flat a sliver is: the distance of the lines of its two edges that cross, over the longer edge.
struct SliverRange {
  double thinnest = 0, thickest = 0;
};

/// Makes `count` slivers of a mesh of tet4, or as many as fit. Where four tetrahedra surround an inner edge,
/// the two on one side of it get the edge across instead, and a sliver fills the gap. Returns how many.
GlobalIndex insert_slivers(Mesh& mesh, GlobalIndex count, const SliverRange& range, RandomNumbers& random);

}  // namespace evert
