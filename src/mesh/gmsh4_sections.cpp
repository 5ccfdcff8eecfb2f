#include "gmsh_file.hpp"
#include <array>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

/// Entities, nodes and elements of Gmsh's format 4.1, text and binary alike.
namespace evert {
namespace {

int read_dimension(GmshFile& file) {
  const int dimension = file.integer("the dimension of an entity");
  if (dimension < 0 || dimension > 3) file.in.fail("the dimension of an entity must be 0, 1, 2 or 3");
  return dimension;
}

void read_entity(GmshFile& file, int dimension) {
  const int tag = file.integer("the tag of an entity");
  const int corners = dimension == 0 ? 3 : 6;  // a point, or the corners of the bounding box
  // Not looked at: the box of an entity without a mesh is infinite.
  for (int i = 0; i < corners; ++i) file.skip_real("a coordinate of an entity");
  auto& groups = file.groups_of_entities[{dimension, tag}];
  const auto group_count = file.count("the number of physical groups of an entity", 2);
  for (GlobalIndex i = 0; i < group_count; ++i)
    groups.push_back(std::abs(file.integer("a physical group of an entity")));  // < 0: reversed
  if (dimension == 0) return;
  const auto bounding = file.count("the number of bounding entities", 2);
  for (GlobalIndex i = 0; i < bounding; ++i) static_cast<void>(file.integer("a bounding entity"));
}

}  // namespace

void read_gmsh4_entities(GmshFile& file) {
  std::array<GlobalIndex, 4> counts{};
  for (auto& count : counts) count = file.count("the number of entities", 8);
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (GlobalIndex i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i)
      read_entity(file, dimension);
  }
}

void read_gmsh4_nodes(GmshFile& file) {
  const auto blocks = file.count("the number of blocks of nodes", 4);
  const auto total = file.count("the number of nodes", 8);
  static_cast<void>(file.size("the smallest tag of a node"));
  static_cast<void>(file.size("the largest tag of a node"));
  file.mesh.reserve_nodes(total);
  for (GlobalIndex block = 0; block < blocks; ++block) {
    const int dimension = read_dimension(file);
    static_cast<void>(file.integer("the tag of an entity"));
    const bool parametric = file.integer("the mark of parametric nodes") != 0;
    const auto count = file.count("the number of nodes of a block", 8);
    for (GlobalIndex i = 0; i < count; ++i) file.tags.add(file.size("the tag of a node"), file.in);
    for (GlobalIndex i = 0; i < count; ++i) {
      Vec3d position{};
      for (auto& coordinate : position.components) coordinate = file.real("a coordinate of a node");
      for (int p = 0; parametric && p < dimension; ++p) file.skip_real("a parameter of a node");
      file.mesh.add_node(position);
    }
  }
  if (file.mesh.node_count() != total)
    file.in.fail("the blocks hold " + std::to_string(file.mesh.node_count()) +
                 " nodes, but the section promises " + std::to_string(total));
  file.tags.close(file.in);
}

void read_gmsh4_elements(GmshFile& file) {
  const auto blocks = file.count("the number of blocks of elements", 4);
  const auto total = file.count("the number of elements", 4);
  static_cast<void>(file.size("the smallest tag of an element"));
  static_cast<void>(file.size("the largest tag of an element"));
  GlobalIndex done = 0;
  std::vector<std::int64_t> nodes;
  for (GlobalIndex block = 0; block < blocks; ++block) {
    const int dimension = read_dimension(file);
    const int entity = file.integer("the tag of an entity");
    const auto& type = file.element_type(file.integer("the type of elements"));
    if (type.dimension != dimension)
      file.in.fail("elements of type " + std::string(type.name) + " cannot be on an entity of dimension " +
                   std::to_string(dimension));
    const auto known = file.groups_of_entities.find({dimension, entity});
    const auto groups = known == file.groups_of_entities.end() ? std::span<const int>{} : known->second;
    const auto count = file.count("the number of elements of a block", 4);
    for (GlobalIndex i = 0; i < count; ++i) {
      const auto tag = file.size("the tag of an element");
      nodes.clear();
      for (int n = 0; n < type.nodes; ++n) nodes.push_back(file.size("a node of an element"));
      file.add_element(tag, type, nodes, groups);
    }
    done += count;
  }
  if (done != total)
    file.in.fail("the blocks hold " + std::to_string(done) + " elements, but the section promises " +
                 std::to_string(total));
}

}  // namespace evert
