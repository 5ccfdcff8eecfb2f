#include "evert/scene/body_mesh.hpp"

#include "evert/mesh/mesh_reader.hpp"
#include "evert/mesh/repair.hpp"

#include "solid.hpp"
#include <type_traits>

namespace evert {
namespace {

Mesh make(const BoxMesh& box) {
  auto mesh = box.edge_length > 0 ? generate_box(box.size, box.edge_length, box.cell)
                                  : generate_box(box.size, box.cells, box.cell, {box.hole, box.cross});
  const Vec3d center = 0.5 * (box.min + box.max);
  for (auto& node : mesh.nodes) node += center;
  return mesh;
}

Mesh make(const FilledShape& filled) {
  Surfaces surfaces;
  read_surfaces(filled.solid, surfaces);
  auto mesh =
      generate(*make_solid({.solid = filled.solid}, surfaces), name_of(filled.solid), filled.edge_length);
  // of fingers thinner than an edge, beads would be left
  if (std::holds_alternative<FigureShape>(filled.solid)) keep_largest_component(mesh);
  return mesh;
}

Mesh make(const RoundBar& bar) { return generate_round_bar(bar); }
Mesh make(const WedgeStack& stack) { return generate_wedge_stack(stack); }
Mesh make(const CutCube& cube) { return generate_cut_cube(cube); }
Mesh make(const SliverBall& ball) { return generate_sliver_ball(ball); }

}  // namespace

Mesh make_body_mesh(const MeshConfig& mesh, std::string_view cell_vectors) {
  return std::visit(
      [&]<class Source>(const Source& source) {
        if constexpr (std::is_same_v<Source, FileMesh>) {
          return read_mesh(source.path, cell_vectors);
        } else {
          return make(source);
        }
      },
      mesh);
}

}  // namespace evert
