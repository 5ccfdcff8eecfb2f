#pragma once
#include "evert/mesh/mesh.hpp"

namespace evert {

/// Puts a node in the middle of every edge of the tetrahedra: each tet4 becomes a straight-edged tet10. A
/// node set gains the middle nodes between two of its nodes; one on the boundary those on the boundary. Not
/// collective; for the rank that holds the mesh. Throws UserError when there are cells of other types, whose
/// faces would no longer match.
void make_quadratic(Mesh& mesh);

}  // namespace evert
