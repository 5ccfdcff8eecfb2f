#pragma once
#include "evert/mesh/mesh.hpp"

namespace evert {

/// Six tetrahedra in the place of each hexahedron. Every face is cut along the diagonal from the smallest of
/// its node numbers, so that neighbours agree.  Dompierre, Labbé, Vallet, Camarero, How to subdivide
/// pyramids, prisms and hexahedra into tetrahedra, 1999
[[nodiscard]] CellBlock split_hexahedra(const CellBlock& hexahedra);

}  // namespace evert
