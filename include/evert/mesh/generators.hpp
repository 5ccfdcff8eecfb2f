#pragma once
#include "evert/mesh/mesh.hpp"
#include "evert/shapes/implicit_surface.hpp"

#include <array>
#include <string>

/// Meshes made from nothing. Boxes are centred on the origin. All have one region, "body", and the node set
/// "surface"; the same arguments give the same mesh, bit by bit. Lengths in metres. Not collective.
namespace evert {

/// How the grid of a box becomes cells.
enum class BoxCells {
  hex8,    ///< one hexahedron a cube
  wedge6,  ///< two wedges a cube, along z
  tet5,    ///< five tetrahedra a cube, mirrored from cube to cube
  tet6,    ///< six tetrahedra a cube around a diagonal (Kuhn)
  bcc,     ///< body-centred cubic lattice: the best-shaped tetrahedra
};

/// A box of cubes with edges as close to `edge_length` as divides the box. Node sets besides "surface": the
/// faces "x_min", "x_max", "y_min", ... "z_max". Throws UserError when a length is not positive and finite,
/// or when there would be more than 2^31 cells.
[[nodiscard]] Mesh generate_box(const Vec3d& size, double edge_length, BoxCells cells = BoxCells::bcc);
/// The same with the number of cubes along each axis, and without the `hole[0]` × `hole[1]` columns of cubes
/// along z in the middle of it. Throws UserError when a hole is not smaller than the box, or cannot be in the
/// middle since it is odd and the box even, or the reverse.
[[nodiscard]] Mesh generate_box(const Vec3d& size, const std::array<int, 3>& divisions, BoxCells cells,
                                const std::array<int, 2>& hole = {});

/// Fills any shape with tetrahedra by isosurface stuffing (Labelle and Shewchuk 2007, uniform): a
/// body-centred cubic lattice whose nodes near the surface are moved onto it and whose tetrahedra are cut
/// along it, so that every dihedral angle is above 9 degrees whatever the shape. `edge_length` is the longer
/// edge of the lattice; the shorter is √3/2 of it, and a volume V takes about 12 V/edge_length³ tetrahedra.
/// Features thinner than an edge are lost and sharp edges are bevelled. Throws UserError when edge_length is
/// not positive and finite or more than half of the shortest side of the shape's bounds, when these are not
/// finite, when there would be more than 2^31 cells, when φ is no number somewhere, or when nothing is
/// inside. Only the sign of φ counts. `name` is that of the shape in messages.
[[nodiscard]] Mesh generate(const ImplicitSurface& shape, const std::string& name, double edge_length);

}  // namespace evert
