#pragma once
#include "evert/mesh/cell_geometry.hpp"
#include "evert/mesh/mesh.hpp"

#include <array>
#include <iosfwd>
#include <string>
#include <vector>

namespace evert {

/// Smallest, largest and mean of something over the cells.
struct Spread {
  double smallest = 0;
  double largest = 0;
  double mean = 0;
};

/// A region or a node set.
struct GroupSize {
  std::string name;
  GlobalIndex size = 0;  ///< cells of a region, nodes of a node set
  double volume = 0;     ///< of a region [m³]
};

/// What there is to know about a mesh before it is simulated.
struct MeshQuality {
  static constexpr int angle_bins = 18;  ///< of 10 degrees each

  GlobalIndex nodes = 0;
  GlobalIndex cells = 0;
  std::array<GlobalIndex, all_cell_types.size()> cells_of_type{};  ///< by number of CellType
  std::vector<GroupSize> regions;
  std::vector<GroupSize> node_sets;
  GlobalIndex boundary_faces = 0;
  GlobalIndex components = 0;  ///< parts of the mesh that share no node

  Vec3d lower{};  ///< corners of the bounding box of all nodes [m]
  Vec3d upper{};
  double total_volume = 0;  ///< [m³]
  Spread volume;            ///< of the cells [m³]
  EdgeRange edges;          ///< [m]

  /// Between the faces at each edge, at both of its ends [degrees].
  Spread dihedral_angle;
  std::array<GlobalIndex, angle_bins> angle_histogram{};
  /// Tetrahedra: longest edge over smallest height, times √(2/3) so that the regular one has 1 (infinite when
  /// flat). Hexahedra and wedges: longest over shortest edge.
  Spread aspect_ratio;

  GlobalIndex negative_cells =
      0;                       ///< of negative volume throughout: `evert mesh convert -reorient` mends them
  GlobalIndex flat_cells = 0;  ///< flat, or turned inside out in a part
  std::vector<GlobalIndex> first_faulty;  ///< the first ten of both, counted over all blocks from 0
  GlobalIndex unused_nodes = 0;           ///< of no cell
  GlobalIndex duplicate_nodes = 0;        ///< as near to one before as 1e-10 of the box's diagonal
};

/// Not collective.
[[nodiscard]] MeshQuality measure_quality(const Mesh& mesh);

/// A report for people, with the histogram of the angles.
void write_quality_text(const MeshQuality& quality, std::ostream& out);
/// The same as one JSON object.
void write_quality_json(const MeshQuality& quality, std::ostream& out);

}  // namespace evert
