#pragma once
#include "evert/elements/element_view.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace evert::trade {

/// A point of a body at rest.
struct BodyPoint {
  std::string body;
  Vec3d position{};  ///< [m]
};

/// Finds the cell that holds a point at rest, among the cells that one rank owns. Knows no MPI.
class PointLocator {
 public:
  explicit PointLocator(const DistributedMesh& mesh);

  /// The value of a field at a point is Σ weights[a] · field[nodes[a]].
  struct Place {
    double outside = 0;  ///< [m] about how far the point is from the cell; infinity: there is no cell
    std::size_t count = 0;
    std::array<LocalIndex, most_nodes> nodes{};
    std::array<double, most_nodes> weights{};
  };
  /// Of the cells of the point's body the one that holds it, or the nearest, whose shape functions then go on
  /// outside for half a cell; farther away the nearest node counts.
  [[nodiscard]] Place locate(const BodyPoint& point) const;

 private:
  struct Cell {
    CellType type = CellType::tet4;
    const LocalIndex* nodes = nullptr;
    Vec3d lower{}, upper{};  ///< box around the cell
  };
  /// Of one body.
  struct Part {
    std::string body;
    std::vector<Cell> cells;
    Vec3d lower{}, upper{};
    std::array<int, 3> bins{1, 1, 1};
    std::vector<std::vector<std::size_t>> cells_of_bin;
  };
  void fill_bins(Part& part) const;
  [[nodiscard]] Place place_in(const Cell& cell, const Vec3d& point) const;

  const DistributedMesh& mesh_;
  std::vector<Part> parts_;
};

/// The part of a region's name that is the body's: "arm" of "arm.bone".
[[nodiscard]] std::string body_of_region(const std::string& region);

}  // namespace evert::trade
