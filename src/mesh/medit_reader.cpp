#include "format_readers.hpp"
#include "mesh_builder.hpp"
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace evert {
namespace {

/// A list of cells in a Medit file, whose node orders are those of VTK: as many node numbers and one
/// reference a line.
struct CellKeyword {
  std::string_view name;
  int nodes;
  std::string_view kind;         ///< of the node set that a reference ≠ 0 makes; "" for volume cells
  std::optional<CellType> cell;  ///< none for a volume: not a cell that Evert knows
};

constexpr std::array cell_keywords{
    CellKeyword{"Tetrahedra", 4, "", CellType::tet4},
    CellKeyword{"TetrahedraP2", 10, "", CellType::tet10},
    CellKeyword{"Hexahedra", 8, "", CellType::hex8},
    CellKeyword{"Prisms", 6, "", CellType::wedge6},
    CellKeyword{"Pentahedra", 6, "", CellType::wedge6},
    CellKeyword{"Pyramids", 5, "", {}},
    CellKeyword{"HexahedraQ2", 27, "", {}},
    CellKeyword{"Triangles", 3, "surface_", {}},
    CellKeyword{"TrianglesP2", 6, "surface_", {}},
    CellKeyword{"Quadrilaterals", 4, "surface_", {}},
    CellKeyword{"QuadrilateralsQ2", 9, "surface_", {}},
    CellKeyword{"Edges", 2, "curve_", {}},
    CellKeyword{"EdgesP2", 3, "curve_", {}},
};

/// A list that says nothing about the simulated body.
struct SkippedKeyword {
  std::string_view name;
  int numbers;  ///< per entry
};

constexpr std::array skipped_keywords{
    SkippedKeyword{"Corners", 1},
    SkippedKeyword{"Ridges", 1},
    SkippedKeyword{"RequiredVertices", 1},
    SkippedKeyword{"RequiredEdges", 1},
    SkippedKeyword{"RequiredTriangles", 1},
    SkippedKeyword{"RequiredQuadrilaterals", 1},
    SkippedKeyword{"RequiredTetrahedra", 1},
    SkippedKeyword{"Normals", 3},
    SkippedKeyword{"NormalAtVertices", 2},
    SkippedKeyword{"NormalAtTriangleVertices", 3},
    SkippedKeyword{"NormalAtQuadrilateralVertices", 3},
    SkippedKeyword{"Tangents", 3},
    SkippedKeyword{"TangentAtVertices", 2},
    SkippedKeyword{"TangentAtEdges", 3},
};

class MeditReader {
 public:
  explicit MeditReader(InputCursor& in) : in_(in) {}

  Mesh read() {
    in_.set_comment('#');
    read_version();
    while (true) {
      // The end is asked for because a cut file would otherwise pass for a whole one.
      const std::string keyword(in_.word("a keyword or 'End'"));
      if (keyword == "End") break;
      read_list(keyword);
    }
    return std::move(mesh_).finish(in_.name());
  }

 private:
  /// A keyword's number may follow without a space: "Dimension3".
  std::int64_t number_after(std::string_view keyword, std::string_view what) {
    const auto word = in_.peek_word();
    if (word == keyword) {
      static_cast<void>(in_.word(what));
      return in_.integer(what);
    }
    in_.set_position(in_.position() + keyword.size());
    return in_.integer(what);
  }

  void read_version() {
    if (!in_.peek_word().starts_with("MeshVersionFormatted")) {
      static_cast<void>(in_.word("MeshVersionFormatted"));
      in_.fail("a Medit file must begin with MeshVersionFormatted");
    }
    const auto version = number_after("MeshVersionFormatted", "the format version");
    if (version < 1 || version > 4)
      in_.fail("Medit format version " + std::to_string(version) + " is not read; allowed are 1 to 4");
    if (!in_.peek_word().starts_with("Dimension")) {
      static_cast<void>(in_.word("Dimension"));
      in_.fail("Dimension is expected here");
    }
    if (number_after("Dimension", "the dimension") != 3) in_.fail("the dimension must be 3");
  }

  void read_list(const std::string& keyword) {
    if (keyword == "Vertices") return read_vertices();
    const auto cells = std::ranges::find(cell_keywords, keyword, &CellKeyword::name);
    if (cells != cell_keywords.end()) return read_cells(*cells);
    const auto skipped = std::ranges::find(skipped_keywords, keyword, &SkippedKeyword::name);
    if (skipped == skipped_keywords.end()) fail_unknown(keyword);
    const auto count = in_.count("the number of " + keyword, static_cast<std::size_t>(2 * skipped->numbers));
    for (GlobalIndex i = 0; i < count * skipped->numbers; ++i)
      static_cast<void>(in_.real("a number of " + keyword));
  }

  [[noreturn]] void fail_unknown(const std::string& keyword) {
    std::vector<std::string> known{"Vertices", "End"};
    for (const auto& cells : cell_keywords) known.emplace_back(cells.name);
    for (const auto& skipped : skipped_keywords) known.emplace_back(skipped.name);
    in_.fail("'" + keyword.substr(0, 40) + "' is no keyword of Medit's that is read" +
             did_you_mean(keyword, known));
  }

  void read_vertices() {
    if (mesh_.node_count() > 0) in_.fail("there is a second list of Vertices");
    const auto count = in_.count("the number of Vertices", 8);
    mesh_.reserve_nodes(count);
    for (GlobalIndex i = 0; i < count; ++i) {
      Vec3d position{};
      for (auto& coordinate : position.components) coordinate = in_.real("a coordinate of a vertex");
      const auto node = mesh_.add_node(position);
      const auto reference = in_.integer("the reference of a vertex");
      if (reference != 0) mesh_.add_to_node_set("vertices_" + std::to_string(reference), {&node, 1});
    }
  }

  void read_cells(const CellKeyword& cells) {
    const bool volume = cells.kind.empty();
    const std::string name(cells.name);
    const auto count = in_.count("the number of " + name, static_cast<std::size_t>(2 * cells.nodes));
    if (volume && !cells.cell && count > 0)
      in_.fail(name + " cannot be simulated; allowed are Tetrahedra, TetrahedraP2, Hexahedra and Prisms");
    std::array<GlobalIndex, 27> numbers{};
    const auto nodes = std::span(numbers).first(static_cast<std::size_t>(cells.nodes));
    for (GlobalIndex i = 0; i < count; ++i) {
      for (auto& node : nodes) node = read_node();
      const auto reference = std::to_string(in_.integer("the reference of a cell"));
      if (volume) {
        mesh_.add_cell(*cells.cell, nodes, mesh_.region("ref_" + reference));
      } else {
        mesh_.count_lower_cell(name);
        if (reference != "0") mesh_.add_to_node_set(std::string(cells.kind) + reference, nodes);
      }
    }
  }

  GlobalIndex read_node() {
    const auto number = in_.integer("a node of a cell");
    if (number < 1 || number > mesh_.node_count())
      in_.fail("there is no vertex " + std::to_string(number) + "; allowed are 1 to " +
               std::to_string(mesh_.node_count()));
    return number - 1;
  }

  InputCursor& in_;
  MeshBuilder mesh_;
};

}  // namespace

Mesh read_medit(InputCursor& in) { return MeditReader(in).read(); }

}  // namespace evert
