#pragma once
#include "evert/filter/filtered_block.hpp"

namespace evert {

/// A block of linear tetrahedra with all of their forces, of which the step takes implicitly what the clamps
/// take off (filter/stiff_modes.hpp): `forces`, of these cells, but for the stable step, which is that of
/// the stiffness that is left to be explicit.  PHYSICS 9
[[nodiscard]] std::unique_ptr<ElasticBlock> make_compliant_block(std::unique_ptr<ElasticBlock> forces,
                                                                 const ElasticCells& cells,
                                                                 std::span<const Vec3d> rest_positions,
                                                                 std::span<const CellClamp> clamps);

}  // namespace evert
