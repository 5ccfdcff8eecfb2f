#include "evert/scene/body_mesh.hpp"

#include "evert/mesh/mesh_reader.hpp"
#include "evert/shapes/solids.hpp"

#include <type_traits>

namespace evert {
namespace {

Mesh make(const BoxMesh& box) {
  auto mesh = box.edge_length > 0 ? generate_box(box.size, box.edge_length, box.cell)
                                  : generate_box(box.size, box.cells, box.cell, box.hole);
  const Vec3d center = 0.5 * (box.min + box.max);
  for (auto& node : mesh.nodes) node += center;
  return mesh;
}

Mesh make(const BallMesh& m) { return generate(Sphere(m.radius), "ball", m.edge_length); }
Mesh make(const TorusMesh& m) {
  return generate(Torus(m.major_radius, m.minor_radius), "torus", m.edge_length);
}
Mesh make(const CylinderMesh& m) { return generate(cylinder(m.radius, m.length), "cylinder", m.edge_length); }
Mesh make(const CapsuleMesh& m) { return generate(Capsule(m.radius, m.length), "capsule", m.edge_length); }
Mesh make(const EllipsoidMesh& m) { return generate(Ellipsoid(m.radii), "ellipsoid", m.edge_length); }

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
