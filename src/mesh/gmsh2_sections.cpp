#include "gmsh_file.hpp"
#include <vector>

/// Nodes and elements of Gmsh's format 2.
namespace evert {
namespace {

/// number type #tags tags... nodes..., one element a line.
void read_text_elements(GmshFile& file, GlobalIndex count) {
  std::vector<std::int64_t> nodes;
  for (GlobalIndex i = 0; i < count; ++i) {
    const int number = file.integer("the number of an element");
    const auto& type = file.element_type(file.integer("the type of an element"));
    const auto tags = file.count("the number of tags of an element", 2);
    int physical_group = 0;
    for (GlobalIndex t = 0; t < tags; ++t) {
      const int tag = file.integer("a tag of an element");
      if (t == 0) physical_group = tag;
    }
    nodes.clear();
    for (int n = 0; n < type.nodes; ++n) nodes.push_back(file.integer("a node of an element"));
    file.add_element(number, type, nodes, {&physical_group, 1});
  }
}

/// Blocks of elements of the same type, each: type, number of elements, #tags; then the elements.
void read_binary_elements(GmshFile& file, GlobalIndex count) {
  std::vector<std::int64_t> nodes;
  for (GlobalIndex done = 0; done < count;) {
    const auto& type = file.element_type(file.integer("the type of a block of elements"));
    const auto size = file.in.plausible_count(file.integer("the size of a block of elements"),
                                              "the size of a block of elements", 8);
    if (size == 0) file.in.fail("a block of elements must not be empty");
    const auto tags = file.in.plausible_count(file.integer("the number of tags of an element"),
                                              "the number of tags of an element", 4);
    for (GlobalIndex i = 0; i < size; ++i) {
      const int number = file.integer("the number of an element");
      int physical_group = 0;
      for (GlobalIndex t = 0; t < tags; ++t) {
        const int tag = file.integer("a tag of an element");
        if (t == 0) physical_group = tag;
      }
      nodes.clear();
      for (int n = 0; n < type.nodes; ++n) nodes.push_back(file.integer("a node of an element"));
      file.add_element(number, type, nodes, {&physical_group, 1});
    }
    done += size;
  }
}

}  // namespace

void read_gmsh2_nodes(GmshFile& file) {
  const auto count = file.in.count("the number of nodes", 8);
  file.in.rest_of_line();
  file.mesh.reserve_nodes(count);
  for (GlobalIndex i = 0; i < count; ++i) {
    file.tags.add(file.integer("the tag of a node"), file.in);
    Vec3d position{};
    for (auto& coordinate : position.components) coordinate = file.real("a coordinate of a node");
    file.mesh.add_node(position);
  }
  file.tags.close(file.in);
}

void read_gmsh2_elements(GmshFile& file) {
  const auto count = file.in.count("the number of elements", 8);
  file.in.rest_of_line();
  if (file.binary) {
    read_binary_elements(file, count);
  } else {
    read_text_elements(file, count);
  }
}

}  // namespace evert
