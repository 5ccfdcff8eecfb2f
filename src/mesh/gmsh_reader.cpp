#include "format_readers.hpp"
#include "gmsh_file.hpp"
#include "number_text.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace evert {
namespace {

constexpr std::array element_types{
    GmshElementType{1, 1, 2, "line2", {}},
    GmshElementType{2, 2, 3, "triangle3", {}},
    GmshElementType{3, 2, 4, "quadrilateral4", {}},
    GmshElementType{4, 3, 4, "tet4", CellType::tet4},
    GmshElementType{5, 3, 8, "hex8", CellType::hex8},
    GmshElementType{6, 3, 6, "wedge6", CellType::wedge6},
    GmshElementType{7, 3, 5, "pyramid5", {}},
    GmshElementType{8, 1, 3, "line3", {}},
    GmshElementType{9, 2, 6, "triangle6", {}},
    GmshElementType{10, 2, 9, "quadrilateral9", {}},
    GmshElementType{11, 3, 10, "tet10", CellType::tet10},
    GmshElementType{12, 3, 27, "hex27", {}},
    GmshElementType{13, 3, 18, "wedge18", {}},
    GmshElementType{14, 3, 14, "pyramid14", {}},
    GmshElementType{15, 0, 1, "point", {}},
    GmshElementType{16, 2, 8, "quadrilateral8", {}},
    GmshElementType{17, 3, 20, "hex20", {}},
    GmshElementType{18, 3, 15, "wedge15", {}},
    GmshElementType{19, 3, 13, "pyramid13", {}},
};

constexpr std::array<std::string_view, 4> kinds_of_groups{"point_", "curve_", "surface_", "volume_"};

/// Reads "$MeshFormat" up to its end; returns the version, 2 or 4.
int read_format(GmshFile& file) {
  auto& in = file.in;
  const auto start = in.word("$MeshFormat");
  if (start == "$NOD") in.fail("this is Gmsh's format 1, which is not read; allowed are 2.2 and 4.1");
  if (start != "$MeshFormat") in.fail("a Gmsh file must begin with $MeshFormat");
  const double version = in.real("the format version");
  if (version != 2.0 && version != 2.1 && version != 2.2 && version != 4.1) {
    in.fail("Gmsh format version " + shortest(version) +
            " is not read; allowed are 2.2 and 4.1 (convert: gmsh -save -format msh41)");
  }
  const auto mode = in.integer("the file type");
  if (mode != 0 && mode != 1) in.fail("the file type must be 0 (ASCII) or 1 (binary)");
  if (in.integer("the data size") != 8) in.fail("the data size must be 8");
  file.binary = mode == 1;
  if (file.binary) {
    in.rest_of_line();
    const auto one = in.binary<std::int32_t>("the number 1 that shows the byte order", false);
    file.swap = one == 0x01000000;
    if (one != 1 && !file.swap) in.fail("the number that shows the byte order must be 1");
  }
  if (in.word("$EndMeshFormat") != "$EndMeshFormat") in.fail("$EndMeshFormat is expected here");
  return version < 4 ? 2 : 4;
}

/// A text section in binary files too.
void read_physical_names(GmshFile& file) {
  auto& in = file.in;
  const auto count = in.count("the number of physical names", 5);
  for (GlobalIndex i = 0; i < count; ++i) {
    const auto dimension = in.integer("the dimension of a physical group");
    if (dimension < 0 || dimension > 3) in.fail("the dimension of a physical group must be 0, 1, 2 or 3");
    const auto number = in.integer("the number of a physical group");
    auto name = in.rest_of_line();
    if (name.size() < 3 || name.front() != '"' || name.back() != '"')
      in.fail("the name of a physical group must stand in double quotes and not be empty");
    name = name.substr(1, name.size() - 2);
    file.physical_names[{static_cast<int>(dimension), static_cast<int>(number)}] = name;
  }
}

void skip_section(InputCursor& in, const std::string& end) {
  const auto found = in.rest().find(end);
  if (found == std::string_view::npos) in.fail("the section has no " + end + " (truncated?)");
  in.set_position(in.position() + found);
}

/// Reads the section called `name`, whose line has been passed, up to its end mark.
void read_section(GmshFile& file, int version, std::string_view name) {
  if (name == "ElementData" && read_gmsh_element_data(file)) return;
  if (name == "PhysicalNames") return read_physical_names(file);
  if (name == "Nodes") return version == 2 ? read_gmsh2_nodes(file) : read_gmsh4_nodes(file);
  if (name == "Elements") return version == 2 ? read_gmsh2_elements(file) : read_gmsh4_elements(file);
  if (name == "Entities" && version == 4) return read_gmsh4_entities(file);
  if (name == "PartitionedEntities")
    file.in.fail("partitioned Gmsh files are not read; save the mesh without partitions");
  skip_section(file.in, "$End" + std::string(name));
}

}  // namespace

int GmshFile::integer(std::string_view what) {
  if (binary) return in.binary<std::int32_t>(what, swap);
  const auto value = in.integer(what);
  if (value != static_cast<std::int32_t>(value)) in.fail(std::string(what) + " does not fit into 32 bits");
  return static_cast<int>(value);
}

std::int64_t GmshFile::size(std::string_view what) {
  return binary ? in.binary<std::int64_t>(what, swap) : in.integer(what);
}

double GmshFile::real(std::string_view what) {
  if (!binary) return in.real(what);
  const auto value = in.binary<double>(what, swap);
  if (!std::isfinite(value)) in.fail(std::string(what) + " must be a finite number");
  return value;
}

void GmshFile::skip_real(std::string_view what) {
  if (binary) {
    static_cast<void>(in.bytes(sizeof(double), what));
  } else {
    static_cast<void>(in.word(what));
  }
}

GlobalIndex GmshFile::count(std::string_view what, std::size_t bytes_each) {
  return in.plausible_count(size(what), what, bytes_each);
}

const GmshElementType& GmshFile::element_type(int id) const {
  const auto found = std::ranges::find(element_types, id, &GmshElementType::id);
  const std::string allowed =
      "allowed are tet4, hex8, wedge6, tet10 and, for node sets, points, lines, "
      "triangles and quadrilaterals";
  if (found == element_types.end())
    in.fail("Gmsh element type " + std::to_string(id) + " is not known; " + allowed);
  if (found->dimension == 3 && !found->cell)
    in.fail("elements of type " + std::string(found->name) + " (Gmsh type " + std::to_string(id) +
            ") cannot be simulated; " + allowed);
  return *found;
}

void GmshFile::add_element(std::int64_t tag, const GmshElementType& type,
                           std::span<const std::int64_t> node_tags, std::span<const int> physical_groups) {
  std::array<GlobalIndex, 10> numbers{};
  const auto nodes = std::span(numbers).first(static_cast<std::size_t>(type.nodes));
  std::optional<CellPlace> cell;
  std::ranges::transform(node_tags, nodes.begin(),
                         [&](std::int64_t node) { return tags.index_of(node, in); });
  if (type.cell == CellType::tet10)
    std::swap(nodes[8], nodes[9]);  // Gmsh: edges (2,3), (1,3); VTK: (1,3), (2,3)
  if (type.cell) {
    cell = mesh.add_cell(*type.cell, nodes, region_of(physical_groups.empty() ? 0 : physical_groups.front()));
    if (!physical_groups.empty()) physical_groups = physical_groups.subspan(1);
  } else {
    mesh.count_lower_cell(type.name);
  }
  if (vectors.wanted()) elements_.push_back({tag, cell});
  for (const int group : physical_groups) {
    if (group != 0) mesh.add_to_node_set(group_name(type.dimension, group), nodes);
  }
}

void GmshFile::set_vector(std::int64_t tag, const Vec3d& vector) {
  if (!std::exchange(elements_sorted_, true)) std::ranges::stable_sort(elements_, {}, &Element::tag);
  const auto found = std::ranges::lower_bound(elements_, tag, {}, &Element::tag);
  if (found == elements_.end() || found->tag != tag)
    in.fail("there is no element " + std::to_string(tag) + " that could have a vector");
  if (found->cell) mesh.set_vector(*found->cell, vector);
}

std::string GmshFile::group_name(int dimension, int number) const {
  const auto named = physical_names.find({dimension, number});
  if (named != physical_names.end()) return named->second;
  return std::string(kinds_of_groups[static_cast<std::size_t>(dimension)]) + std::to_string(number);
}

std::int32_t GmshFile::region_of(int physical_group) {
  const auto known = regions_.find(physical_group);
  if (known != regions_.end()) return known->second;
  const auto region = mesh.region(physical_group == 0 ? "default" : group_name(3, physical_group));
  regions_.emplace(physical_group, region);
  return region;
}

Mesh read_gmsh(InputCursor& in, VectorField& vectors) {
  GmshFile file(in, vectors);
  const int version = read_format(file);
  bool has_nodes = false;
  bool has_elements = false;
  while (!in.at_end()) {
    const auto heading = in.word("a section");
    if (!heading.starts_with('$')) in.fail("a section such as $Nodes is expected here");
    const auto name = heading.substr(1);
    if ((name == "Nodes" && has_nodes) || (name == "Elements" && has_elements))
      in.fail("there is a second section $" + std::string(name));
    if (name == "ElementData" && vectors.wanted() && !has_elements)
      in.fail("the section $ElementData comes before $Elements");
    if (name == "Elements" && !has_nodes) in.fail("the section $Elements comes before $Nodes");
    in.rest_of_line();
    read_section(file, version, name);
    if (in.word("$End" + std::string(name)) != "$End" + std::string(name))
      in.fail("$End" + std::string(name) + " is expected here: the section is longer than its counts say");
    has_nodes |= name == "Nodes";
    has_elements |= name == "Elements";
  }
  if (!has_nodes) in.fail("the file has no section $Nodes (truncated?)");
  if (!has_elements) in.fail("the file has no section $Elements (truncated?)");
  vectors.expect_found(in.name());
  return std::move(file.mesh).finish(in.name());
}

}  // namespace evert
