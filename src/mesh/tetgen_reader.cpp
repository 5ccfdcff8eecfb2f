#include "format_readers.hpp"
#include "mesh_builder.hpp"
#include "node_tags.hpp"
#include "number_text.hpp"
#include <array>
#include <string>

namespace evert {
namespace {

void require_end(InputCursor& in, const std::string& what) {
  if (in.at_end()) return;
  static_cast<void>(in.word("the end"));
  in.fail("there is more than the " + what + " that the first line promises");
}

/// The first line: #nodes dimension #attributes #markers; then number x y z attributes... marker.
void read_nodes(InputCursor& in, MeshBuilder& mesh, NodeTags& tags) {
  const auto count = in.count("the number of nodes", 8);
  if (in.integer("the dimension") != 3) in.fail("the dimension must be 3");
  const auto attributes = in.count("the number of attributes", 1);
  const auto markers = in.integer("the number of boundary markers");
  if (markers != 0 && markers != 1) in.fail("the number of boundary markers must be 0 or 1");
  mesh.reserve_nodes(count);
  for (GlobalIndex i = 0; i < count; ++i) {
    tags.add(in.integer("the number of a node"), in);
    Vec3d position{};
    for (auto& coordinate : position.components) coordinate = in.real("a coordinate of a node");
    const auto node = mesh.add_node(position);
    for (GlobalIndex a = 0; a < attributes; ++a) static_cast<void>(in.real("an attribute of a node"));
    const auto marker = markers == 1 ? in.integer("the boundary marker of a node") : 0;
    if (marker != 0) mesh.add_to_node_set("marker_" + std::to_string(marker), {&node, 1});
  }
  require_end(in, std::to_string(count) + " nodes");
  tags.close(in);
}

/// The first line: #tetrahedra nodes-per-tetrahedron #attributes; then number nodes... attributes...; the
/// first attribute is the region.
void read_tetrahedra(InputCursor& in, MeshBuilder& mesh, const NodeTags& tags) {
  const auto count = in.count("the number of tetrahedra", 10);
  if (in.integer("the number of nodes of a tetrahedron") != 4)
    in.fail("tetrahedra must have 4 nodes (TetGen without -o2)");
  const auto attributes = in.count("the number of attributes", 1);
  for (GlobalIndex i = 0; i < count; ++i) {
    static_cast<void>(in.integer("the number of a tetrahedron"));
    std::array<GlobalIndex, 4> nodes{};
    for (auto& node : nodes) node = tags.index_of(in.integer("a node of a tetrahedron"), in);
    std::string region = "default";
    for (GlobalIndex a = 0; a < attributes; ++a) {
      const double attribute = in.real("an attribute of a tetrahedron");
      if (a == 0) region = "region_" + shortest(attribute);
    }
    mesh.add_cell(CellType::tet4, nodes, mesh.region(region));
  }
  require_end(in, std::to_string(count) + " tetrahedra");
}

}  // namespace

Mesh read_tetgen(const std::filesystem::path& path) {
  auto node_path = path;
  auto cell_path = path;
  node_path.replace_extension(".node");
  cell_path.replace_extension(".ele");
  const auto node_text = read_whole_file(node_path);
  const auto cell_text = read_whole_file(cell_path);
  InputCursor nodes(node_text, node_path.string());
  InputCursor cells(cell_text, cell_path.string());
  nodes.set_comment('#');
  cells.set_comment('#');
  MeshBuilder mesh;
  NodeTags tags;
  read_nodes(nodes, mesh, tags);
  read_tetrahedra(cells, mesh, tags);
  return std::move(mesh).finish(cell_path.string());
}

}  // namespace evert
