#pragma once
#include "input_cursor.hpp"
#include "mesh_builder.hpp"
#include "node_tags.hpp"
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// What the readers of Gmsh's two formats share.
namespace evert {

/// One of Gmsh's element types.
struct GmshElementType {
  int id;
  int dimension;
  int nodes;
  std::string_view name;
  std::optional<CellType> cell;  ///< none: not a volume cell that Evert knows
};

/// A Gmsh file while it is read. Numbers come as words or as bytes, by the file's header.
class GmshFile {
 public:
  explicit GmshFile(InputCursor& cursor) : in(cursor) {}

  [[nodiscard]] int integer(std::string_view what);
  [[nodiscard]] std::int64_t size(std::string_view what);  ///< Gmsh's size_t
  [[nodiscard]] double real(std::string_view what);        ///< finite
  void skip_real(std::string_view what);
  [[nodiscard]] GlobalIndex count(std::string_view what, std::size_t bytes_each);

  /// Throws when Evert cannot use elements of this type.
  [[nodiscard]] const GmshElementType& element_type(int id) const;
  /// Adds the element with these nodes to the physical groups given; the first of a volume is its region.
  void add_element(const GmshElementType& type, std::span<const std::int64_t> tags,
                   std::span<const int> physical_groups);

  InputCursor& in;
  bool binary = false;
  bool swap = false;  ///< bytes of numbers stand in the other order than in memory
  MeshBuilder mesh;
  NodeTags tags;
  std::map<std::pair<int, int>, std::string> physical_names;           ///< (dimension, number) → name
  std::map<std::pair<int, int>, std::vector<int>> groups_of_entities;  ///< (dimension, tag) → physical groups

 private:
  [[nodiscard]] std::string group_name(int dimension, int number) const;
  [[nodiscard]] std::int32_t region_of(int physical_group);
  void add_to_group(int dimension, int number, std::span<const GlobalIndex> nodes);

  std::map<int, std::int32_t> regions_;  // physical group of volumes → region
};

void read_gmsh2_nodes(GmshFile& file);
void read_gmsh2_elements(GmshFile& file);
void read_gmsh4_entities(GmshFile& file);
void read_gmsh4_nodes(GmshFile& file);
void read_gmsh4_elements(GmshFile& file);

}  // namespace evert
