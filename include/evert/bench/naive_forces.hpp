#pragma once
#include "evert/core/index.hpp"
#include "evert/materials/neo_hookean.hpp"

#include <array>
#include <span>
#include <vector>

/// The yardstick of the tetrahedral force kernels: what one writes first.
namespace evert::bench {

/// Elastic forces of neo-Hookean tetrahedra, one after the other: a struct per cell, Eigen's JacobiSVD, the
/// signs put right as in paper A, section 5.
class NaiveForces {
 public:
  /// `nodes`: four local numbers per cell, of positive volume at rest.
  NaiveForces(std::span<const LocalIndex> nodes, std::span<const Vec3d> rest_positions,
              const NeoHookean& material);

  /// f −= ∂ψ/∂x over cells [begin, end); x y z per node.
  void add(std::span<const double> x, std::span<double> f, std::size_t begin, std::size_t end) const;

  [[nodiscard]] std::size_t cells() const { return cells_.size(); }
  /// F of a cell.
  [[nodiscard]] Mat3d deformation_gradient(std::span<const double> x, std::size_t cell) const;

 private:
  struct Cell {
    std::array<LocalIndex, 4> nodes;
    Mat3d inverse_rest_edges;  ///< D_m⁻¹ [1/m]
    double volume;             ///< [m^3]
  };

  std::vector<Cell> cells_;
  NeoHookean material_;
};

}  // namespace evert::bench
