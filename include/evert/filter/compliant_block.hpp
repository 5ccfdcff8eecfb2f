#pragma once
#include "evert/filter/filtered_block.hpp"

#include <memory>
#include <span>

namespace evert {

/// A block of linear tetrahedra with all of their forces, of which the step takes implicitly what the clamps
/// take off (filter/stiff_modes.hpp): `forces`, of these cells, but for the stable step, which is that of
/// the stiffness that is left to be explicit.  PHYSICS 9
class CompliantBlock : public ElasticBlock {
 public:
  /// Other shapes of the same cells, and clamps. The mass shares stay.
  virtual void reshape(std::span<const TetShape> shapes, std::span<const CellClamp> clamps) = 0;
};

/// One shape and clamp a cell.
[[nodiscard]] std::unique_ptr<CompliantBlock> make_compliant_block(std::unique_ptr<ElasticBlock> forces,
                                                                   const ElasticCells& cells,
                                                                   std::span<const TetShape> shapes,
                                                                   std::span<const CellClamp> clamps);

}  // namespace evert
