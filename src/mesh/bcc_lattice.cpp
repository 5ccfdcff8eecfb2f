#include "bcc_lattice.hpp"

#include <cmath>

namespace evert {

BccLattice::BccLattice(const Vec3d& center, const Vec3d& size, double edge_length)
    : center_(center), half_edge_(edge_length / 2), cubes_{}, corner_count_(1), cube_count_(1) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cubes_[axis] = 2 * (static_cast<std::int32_t>(std::ceil(size[axis] / 2 / edge_length)) + 1);
    corner_count_ *= cubes_[axis] + 1;
    cube_count_ *= cubes_[axis];
  }
}

GlobalIndex BccLattice::number_of(const LatticePoint& point) const {
  const int parity = point[0] & 1;
  return (parity == 0 ? 0 : corner_count_) + grid_number(point, parity);
}

GlobalIndex BccLattice::grid_number(const LatticePoint& point, int parity) const {
  const auto row = GlobalIndex{cubes_[0]} + 1 - parity;
  const auto rows = GlobalIndex{cubes_[1]} + 1 - parity;
  return ((point[2] / 2) * rows + point[1] / 2) * row + point[0] / 2;
}

Vec3d BccLattice::position_of(const LatticePoint& point) const {
  Vec3d position{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    position[axis] = center_[axis] + half_edge_ * (point[axis] - cubes_[axis]);
  return position;
}

bool BccLattice::contains(const LatticePoint& point) const {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (point[axis] < 0 || point[axis] > 2 * cubes_[axis]) return false;
  return true;
}

bool BccLattice::is_outermost(const LatticePoint& point) const {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (point[axis] < 2 || point[axis] > 2 * cubes_[axis] - 2) return true;
  return false;
}

}  // namespace evert
