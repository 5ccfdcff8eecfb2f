#pragma once
#include "evert/math/vec3.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// In which way a tetrahedron is bad: which of its distances is short, and so where it vibrates fast.
///
/// G = Σ g_i g_iᵀ over the shape gradients g_i has the eigenvalues γ1 ≥ γ2 ≥ γ3, one over the square of the
/// extent along each axis.  paper B, section 5 and figure 1; PHYSICS 9
namespace evert {

enum class ShapeClass {
  well_shaped,  ///< no direction is much shorter than another
  needle,       ///< two short directions: three short edges around a face, three long ones
  spindle,      ///< two short directions: two short edges far from each other
  wedge,        ///< flat, with one short edge
  cap,          ///< flat, one node near the middle of the face opposite
  sliver,       ///< flat, two edges that nearly cross
};
inline constexpr std::array all_shape_classes{ShapeClass::well_shaped, ShapeClass::needle,
                                              ShapeClass::spindle,     ShapeClass::wedge,
                                              ShapeClass::cap,         ShapeClass::sliver};

/// "well-shaped", "needle", ...
[[nodiscard]] std::string_view name_of(ShapeClass shape);

/// Of a tetrahedron with these corners [m]; its volume must not be zero, its orientation does not matter.
[[nodiscard]] ShapeClass shape_class(std::span<const Vec3d, 4> corners);

/// What is short in a bad tetrahedron: edges, numbered as in edges_of_tet, or the height of a corner.
struct ShortDistances {
  std::vector<std::size_t> edges;
  std::optional<std::size_t> apex;
};

/// By its class: of a needle the three edges of the small face, of a wedge the short edge, of a cap the
/// height of the corner that is near the face opposite; of others all edges.
[[nodiscard]] ShortDistances short_distances(std::span<const Vec3d, 4> corners);

}  // namespace evert
