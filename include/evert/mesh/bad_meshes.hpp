#pragma once
#include "evert/mesh/mesh.hpp"

#include <cstdint>

/// Meshes with bad elements, to try explicit steps and the modal filter on. All tet4, with one region,
/// "body", and the node set "surface", around the origin; the same arguments give the same mesh, bit by bit.
/// Lengths in metres. Not collective.
namespace evert {

/// Flat prisms on top of each other, each cut into three wedges, between two regular tetrahedra along z.
/// paper B, section 6.1
struct WedgeStack {
  double edge_length = 1;  ///< [m] of the tetrahedra
  double edge_ratio =
      19;          ///< [-] > 0, of it over the height of a prism, which is the short edge of its wedges
  int layers = 2;  ///< prisms, at least 1
};

/// The tips are the node sets "z_min" and "z_max". Throws UserError for what the fields do not allow.
[[nodiscard]] Mesh generate_wedge_stack(const WedgeStack& stack);

/// A cube of cubes of five tetrahedra each, cut into two bodies that touch along a plane.  paper B, section
/// 6.2; PHYSICS 9
struct CutCube {
  double size = 4;             ///< [m] of its edges
  int cells = 4;               ///< cubes along each edge
  Vec3d normal{0.35, 0.2, 1};  ///< of the plane, of any length
  Vec3d through{0, 0, 0.13};   ///< [m] a point of the plane
  double snap = 0.3;           ///< [-] 0 to 0.5: nodes nearer to the plane than so many edges of the small
                               ///< cubes are moved onto it, and the tetrahedra there are not cut
};

/// The faces of the cube are the node sets "x_min", ... "z_max", those of the cut "lower_cut" and
/// "upper_cut", seen along the normal. Throws UserError when the plane has no direction, leaves all on one
/// side, or when moving nodes turns tetrahedra inside out.
[[nodiscard]] Mesh generate_cut_cube(const CutCube& cube);

/// A ball as `generate` fills it, with shaken nodes and slivers: tetrahedra of four nodes that nearly lie in
/// a plane, as meshing by Delaunay's criterion leaves them.
struct SliverBall {
  double radius = 0;       ///< [m]
  double edge_length = 0;  ///< [m] of the lattice
  double slivers = 0.01;   ///< [-] 0 to 0.05: share of all tetrahedra
  double jitter = 0.1;     ///< [-] 0 to 0.3: the largest shift of inner nodes along each axis, in edge_length
  double thinnest = 0.01;  ///< [-] 0 to 0.1: least distance of the two edges of a sliver that cross, over the
                           ///< longer of them
  std::uint64_t seed = 1;
};

/// Throws UserError for impossible sizes, and when there is no room for so many slivers.
[[nodiscard]] Mesh generate_sliver_ball(const SliverBall& ball);

}  // namespace evert
