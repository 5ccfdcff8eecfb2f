#pragma once
#include "evert/mesh/mesh.hpp"
#include "evert/scene/config.hpp"

#include <vector>

namespace evert {

/// Not collective; for rank 0. Gives the cells of `mesh`, that of `body` in its place, the directions of
/// their fibres, of length 1, as CellBlock::vectors; 0 to those of regions that are not among `with_fibres`.
/// A field of the mesh file is expected there already. Throws UserError when a cell that needs one has none.
void set_fibre_directions(Mesh& mesh, const BodyConfig& body, const std::vector<bool>& with_fibres);

}  // namespace evert
