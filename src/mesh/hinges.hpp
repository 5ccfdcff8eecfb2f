#pragma once
#include "evert/core/index.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace evert {

/// Tetrahedra, `nodes` in fours, that hang on the others by an edge or a corner only, which has no stiffness:
/// a body folds there. Pieces that share nodes but no face with a larger one, the largest first, as the
/// numbers of their cells; none in a sound mesh, which may still be of several bodies.
[[nodiscard]] std::vector<std::vector<std::size_t>> hinged_pieces(std::span<const GlobalIndex> nodes);

}  // namespace evert
