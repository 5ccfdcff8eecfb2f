#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/core/positive.hpp"
#include "evert/mesh/bad_meshes.hpp"
#include "evert/mesh/boundary.hpp"
#include "evert/mesh/generators.hpp"

#include "plane_cut.hpp"
#include <algorithm>
#include <cmath>

namespace evert {

Mesh generate_cut_cube(const CutCube& cube) {
  require_positive(cube.size, "size");
  const double length = norm(cube.normal);
  if (!(length > 0) || !std::isfinite(length)) throw UserError("normal must have a direction, and be finite");
  for (const double component : cube.through.components)
    if (!std::isfinite(component)) throw UserError("through must be finite");
  if (!(cube.snap >= 0 && cube.snap <= 0.5))
    throw UserError(formatted("snap is %g, but must be from 0 to 0.5", cube.snap));
  auto mesh =
      generate_box({cube.size, cube.size, cube.size}, {cube.cells, cube.cells, cube.cells}, BoxCells::tet5);
  cut_along(mesh, {(1 / length) * cube.normal, cube.through, cube.snap * cube.size / cube.cells});
  const auto surface = std::ranges::find(mesh.node_sets, "surface", &NodeSet::name);
  surface->nodes = boundary_nodes(mesh);
  return mesh;
}

}  // namespace evert
