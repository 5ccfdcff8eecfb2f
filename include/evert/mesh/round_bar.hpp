#pragma once
#include "evert/mesh/mesh.hpp"

namespace evert {

enum class RoundBarCells {
  hex8,
  tet6,  ///< six tetrahedra in the place of each hexahedron
};

/// A bar or a tube of hexahedra around the y axis: layers of a square of cells in the middle and rings around
/// it, or of rings alone.
struct RoundBar {
  double radius = 0;        ///< [m]
  double length = 0;        ///< [m] along y
  double inner_radius = 0;  ///< [m] of a tube; 0: a bar
  int quarter = 4;          ///< cells along a quarter of the circumference
  int rings = 4;            ///< around the square, or of a tube
  int layers = 0;           ///< along y; 0: as many as make the cells about as long as they are wide
  RoundBarCells cell = RoundBarCells::hex8;
};

/// Centred on the origin; region "body", node sets "surface", "y_min", "y_max". Not collective. Throws
/// UserError for what the fields do not allow, and for more than 2^31 cells.
[[nodiscard]] Mesh generate_round_bar(const RoundBar& bar);

}  // namespace evert
