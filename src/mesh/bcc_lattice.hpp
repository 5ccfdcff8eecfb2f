#pragma once
#include "evert/core/index.hpp"
#include "evert/math/vec3.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace evert {

/// A point of the lattice in half edges: all three even (a corner of a cube) or all three odd (the middle of
/// one).
using LatticePoint = std::array<std::int32_t, 3>;

/// A body-centred cubic lattice: the corners and the middles of a grid of cubes. Two corners, or two middles,
/// at the distance of the cube's edge are joined by a long edge; a corner and the middle of its cube by a
/// short one (√3/2).
class BccLattice {
 public:
  /// Cubes with edges `edge_length` [m], centred on `center`, enough to hold `size` and a layer more on each
  /// side. The number of cubes along each axis is even, so that the centre is a corner.
  BccLattice(const Vec3d& center, const Vec3d& size, double edge_length);

  [[nodiscard]] GlobalIndex point_count() const { return corner_count_ + cube_count_; }
  /// Dense number of a point: corners first.
  [[nodiscard]] GlobalIndex number_of(const LatticePoint& point) const;
  [[nodiscard]] Vec3d position_of(const LatticePoint& point) const;
  [[nodiscard]] bool contains(const LatticePoint& point) const;
  /// On the boundary of the lattice, or a middle next to it.
  [[nodiscard]] bool is_outermost(const LatticePoint& point) const;
  /// Length of the long or of the short edges [m].
  [[nodiscard]] double edge_length(bool is_long) const {
    return half_edge_ * (is_long ? 2.0 : std::numbers::sqrt3);
  }

  /// Calls visit(point, number) for all points, numbers rising.
  template <class Visit>
  void for_each_point(Visit&& visit) const;
  /// Calls visit(points) for all tetrahedra, each of positive volume: two middles joined through a face and
  /// two neighbouring corners of this face.
  template <class Visit>
  void for_each_tetrahedron(Visit&& visit) const;

  /// Steps to the ends of the 14 edges of a point: 6 long ones, then 8 short ones.
  static constexpr std::array<LatticePoint, 14> edges{{{2, 0, 0},
                                                       {-2, 0, 0},
                                                       {0, 2, 0},
                                                       {0, -2, 0},
                                                       {0, 0, 2},
                                                       {0, 0, -2},
                                                       {-1, -1, -1},
                                                       {1, -1, -1},
                                                       {-1, 1, -1},
                                                       {1, 1, -1},
                                                       {-1, -1, 1},
                                                       {1, -1, 1},
                                                       {-1, 1, 1},
                                                       {1, 1, 1}}};
  static constexpr std::size_t long_edges = 6;

 private:
  [[nodiscard]] GlobalIndex grid_number(const LatticePoint& point, int parity) const;

  Vec3d center_;
  double half_edge_;
  std::array<std::int32_t, 3> cubes_;
  GlobalIndex corner_count_;
  GlobalIndex cube_count_;
};

/// True when the edge between two points joined in the lattice is a long one.
[[nodiscard]] constexpr bool is_long_edge(const LatticePoint& a, const LatticePoint& b) {
  return (a[0] & 1) == (b[0] & 1);
}

template <class Visit>
void BccLattice::for_each_point(Visit&& visit) const {
  GlobalIndex number = 0;
  for (int parity = 0; parity < 2; ++parity)
    for (int k = parity; k <= 2 * cubes_[2]; k += 2)
      for (int j = parity; j <= 2 * cubes_[1]; j += 2)
        for (int i = parity; i <= 2 * cubes_[0]; i += 2) visit(LatticePoint{i, j, k}, number++);
}

template <class Visit>
void BccLattice::for_each_tetrahedron(Visit&& visit) const {
  constexpr std::array<std::array<std::int32_t, 2>, 4> ring{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (int k = 1; k < 2 * cubes_[2]; k += 2)
    for (int j = 1; j < 2 * cubes_[1]; j += 2)
      for (int i = 1; i < 2 * cubes_[0]; i += 2)
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const LatticePoint middle{i, j, k};
          auto next = middle;
          next[axis] += 2;
          if (!contains(next)) continue;
          std::array<LatticePoint, 4> face{};
          for (std::size_t c = 0; c < 4; ++c) {
            face[c] = middle;
            face[c][axis] += 1;
            face[c][(axis + 1) % 3] += ring[c][0];
            face[c][(axis + 2) % 3] += ring[c][1];
          }
          for (std::size_t c = 0; c < 4; ++c)
            visit(std::array<LatticePoint, 4>{face[(c + 1) % 4], face[c], next, middle});
        }
}

}  // namespace evert
