#pragma once
#include "evert/mesh/mesh.hpp"

namespace evert {

struct CutPlane {
  Vec3d normal;     ///< of length 1
  Vec3d through;    ///< [m]
  double snap = 0;  ///< [m] nodes that are not as far from the plane as this are moved onto it first
};

/// Cuts a mesh of tet4 into what is below and what is above the plane, which share no node. Tetrahedra that
/// cross it are divided along it; where a face of theirs leaves a quadrilateral, the diagonal from the corner
/// of lowest x, of these of lowest y and then z, divides it, so that neighbours agree. Node sets get the new
/// nodes that lie between or upon nodes of theirs; "lower_cut" and "upper_cut" are added. Throws UserError
/// when all is on one side or when moving nodes has turned a tetrahedron inside out.
void cut_along(Mesh& mesh, const CutPlane& plane);

}  // namespace evert
