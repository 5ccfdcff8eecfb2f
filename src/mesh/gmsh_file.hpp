#pragma once
#include "input_cursor.hpp"
#include "mesh_builder.hpp"
#include "node_tags.hpp"
#include "vector_field.hpp"
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
  GmshFile(InputCursor& cursor, VectorField& wanted) : in(cursor), vectors(wanted) {}

  [[nodiscard]] int integer(std::string_view what);
  [[nodiscard]] std::int64_t size(std::string_view what);  ///< Gmsh's size_t
  [[nodiscard]] double real(std::string_view what);        ///< finite
  void skip_real(std::string_view what);
  [[nodiscard]] GlobalIndex count(std::string_view what, std::size_t bytes_each);

  /// Throws when Evert cannot use elements of this type.
  [[nodiscard]] const GmshElementType& element_type(int id) const;
  /// Adds the element `tag` with these nodes to the physical groups given; the first of a volume is its
  /// region.
  void add_element(std::int64_t tag, const GmshElementType& type, std::span<const std::int64_t> node_tags,
                   std::span<const int> physical_groups);
  /// Gives the element `tag` its vector; only volumes keep it. Throws when there is no such element.
  void set_vector(std::int64_t tag, const Vec3d& vector);

  InputCursor& in;
  VectorField& vectors;
  bool binary = false;
  bool swap = false;  ///< bytes of numbers stand in the other order than in memory
  MeshBuilder mesh;
  NodeTags tags;
  std::map<std::pair<int, int>, std::string> physical_names;           ///< (dimension, number) → name
  std::map<std::pair<int, int>, std::vector<int>> groups_of_entities;  ///< (dimension, tag) → physical groups

 private:
  [[nodiscard]] std::string group_name(int dimension, int number) const;
  [[nodiscard]] std::int32_t region_of(int physical_group);

  struct Element {
    std::int64_t tag;
    std::optional<CellPlace> cell;  // none: of lower dimension
  };

  std::map<int, std::int32_t> regions_;  // physical group of volumes → region
  std::vector<Element> elements_;  // only where vectors are wanted; by rising tag once one was looked for
  bool elements_sorted_ = false;
};

void read_gmsh2_nodes(GmshFile& file);
void read_gmsh2_elements(GmshFile& file);
void read_gmsh4_entities(GmshFile& file);
void read_gmsh4_nodes(GmshFile& file);
void read_gmsh4_elements(GmshFile& file);
/// The section up to its end mark when it is the field that is wanted; otherwise false, somewhere inside.
[[nodiscard]] bool read_gmsh_element_data(GmshFile& file);

}  // namespace evert
