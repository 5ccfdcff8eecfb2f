#include "case.hpp"

#include <stdexcept>

namespace evert::cli {
namespace {

constexpr auto good_scene = R"(name: test
end_time: 2e-3
gravity: [0, -9.81, 0]
output: {directory: out, frames_per_second: 1000}
bodies:
  cube:
    mesh: {generate: box, size: [1, 1, 1], cells: [2, 2, 2], cell: tet6}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.3}
    damping: {model: rotated, stiffness_proportional: 0.01}
obstacles:
  ground: {shape: half_space, normal: [0, 1, 0], point: [0, -1, 0], friction: 0.4}
petsc: {damping_ksp_rtol: 1e-6}
)";

constexpr auto good_gmsh2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
3 7 "flesh"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
$EndNodes
$Elements
6
1 4 2 7 1 1 2 3 7
2 4 2 7 1 1 3 4 7
3 4 2 7 1 1 4 8 7
4 4 2 7 1 1 8 5 7
5 4 2 7 1 1 5 6 7
6 4 2 7 1 1 6 2 7
$EndElements
)";

constexpr auto good_gmsh4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
0 0 0 1
1 0 0 0 1 1 1 0 0
$EndEntities
$Nodes
1 8 1 8
3 1 0 8
1
2
3
4
5
6
7
8
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
$EndNodes
$Elements
1 6 1 6
3 1 4 6
1 1 2 3 7
2 1 3 4 7
3 1 4 8 7
4 1 8 5 7
5 1 5 6 7
6 1 6 2 7
$EndElements
)";

constexpr auto good_medit = R"(MeshVersionFormatted 2
Dimension 3
Vertices
8
0 0 0 1
1 0 0 1
1 1 0 1
0 1 0 1
0 0 1 1
1 0 1 1
1 1 1 1
0 1 1 1
Tetrahedra
6
1 2 3 7 1
1 3 4 7 1
1 4 8 7 1
1 8 5 7 1
1 5 6 7 1
1 6 2 7 1
End
)";

std::string edited(std::string text, const std::vector<Edit>& edits) {
  for (const auto& [from, to] : edits) {
    const auto place = text.find(from);
    if (place == std::string::npos || text.find(from, place + 1) != std::string::npos)
      throw std::logic_error("the text to edit must stand there exactly once: " + from);
    text.replace(place, from.size(), to);
  }
  return text;
}

}  // namespace

File scene(const std::vector<Edit>& edits) { return {"scene.yaml", edited(good_scene, edits)}; }

File scene_with_mesh(const std::string& mesh_file) {
  return scene({{"generate: box, size: [1, 1, 1], cells: [2, 2, 2], cell: tet6", "file: " + mesh_file}});
}

File gmsh2(const std::vector<Edit>& edits) { return {"cube.msh", edited(good_gmsh2, edits)}; }
File gmsh4(const std::vector<Edit>& edits) { return {"cube.msh", edited(good_gmsh4, edits)}; }
File medit(const std::vector<Edit>& edits) { return {"cube.mesh", edited(good_medit, edits)}; }

File cut(File file, int tenths) {
  file.content.resize(file.content.size() * static_cast<std::size_t>(tenths) / 10);
  return file;
}

}  // namespace evert::cli
