#include "format_readers.hpp"
#include "vtk_grid.hpp"
#include "vtk_numbers.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <string>
#include <vector>

/// Legacy VTK: versions 1 to 4 list cells as "number of points, points", version 5 has OFFSETS and
/// CONNECTIVITY.
namespace evert {
namespace {

/// Undoes the %20 of VTK's names.
std::string decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto code = text.substr(i + 1, 2);
    unsigned char byte = 0;
    if (text[i] == '%' && code.size() == 2 &&
        std::from_chars(code.data(), code.data() + 2, byte, 16).ptr == code.end()) {
      result += static_cast<char>(byte);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

class VtkReader {
 public:
  VtkReader(InputCursor& in, VectorField& vectors) : in_(in), vectors_(vectors) {}

  Mesh read() {
    read_header();
    while (!in_.at_end()) read_part(std::string(in_.word("a keyword")));
    if (!has_points_ || !has_cells_ || !has_types_)
      in_.fail(std::string("the file has no ") +
               (!has_points_  ? "POINTS"
                : !has_cells_ ? "CELLS"
                              : "CELL_TYPES") +
               " (truncated?)");
    vectors_.expect_found(in_.name());
    return mesh_of(grid_, in_);
  }

 private:
  enum class Owner { grid, cells, points };

  void read_header() {
    for (const auto word : {"#", "vtk", "DataFile", "Version"})
      if (in_.word("'# vtk DataFile Version'") != word)
        in_.fail("a VTK file must begin with '# vtk DataFile Version'");
    version_ = in_.real("the format version");
    if (version_ < 1 || version_ >= 6)
      in_.fail("this VTK format version is not read; allowed are 1.0 to 5.1");
    in_.rest_of_line();
    in_.rest_of_line();  // the title
    const auto mode = in_.word("ASCII or BINARY");
    if (mode != "ASCII" && mode != "BINARY") in_.fail("ASCII or BINARY is expected here");
    binary_ = mode == "BINARY";
    if (in_.word("DATASET") != "DATASET") in_.fail("DATASET is expected here");
    if (in_.word("the kind of dataset") != "UNSTRUCTURED_GRID")
      in_.fail("this kind of dataset is not read; allowed is UNSTRUCTURED_GRID");
  }

  void read_part(const std::string& keyword) {
    if (keyword == "POINTS") return read_points();
    if (keyword == "CELLS") return version_ < 5 ? read_cells() : read_offset_cells();
    if (keyword == "CELL_TYPES") return read_cell_types();
    if (keyword == "CELL_DATA") return begin_data(Owner::cells, grid_.types.size());
    if (keyword == "POINT_DATA") return begin_data(Owner::points, grid_.points.size());
    if (keyword == "FIELD") return read_field();
    if (keyword == "METADATA") return skip_metadata();
    read_attribute(keyword);
  }

  const VtkNumberType& read_type() {
    const auto name = in_.word("a number type");
    const auto* type = legacy_number_type(name);
    if (type == nullptr) in_.fail("'" + std::string(name.substr(0, 40)) + "' is no number type of VTK's");
    return *type;
  }

  /// Bytes that a number needs at least.
  [[nodiscard]] std::size_t bytes_of(const VtkNumberType& type) const { return binary_ ? type.bytes : 2; }
  std::int64_t integer(const VtkNumberType& type, std::string_view what) {
    return read_integer(in_, type, binary_, swap_, what);
  }
  std::vector<std::int64_t> integers(const VtkNumberType& type, GlobalIndex count, std::string_view what) {
    std::vector<std::int64_t> values;
    in_.plausible_count(count, what, bytes_of(type));
    values.reserve(static_cast<std::size_t>(count));
    for (GlobalIndex i = 0; i < count; ++i) values.push_back(integer(type, what));
    return values;
  }

  void require_first(bool& seen, std::string_view name) {
    if (seen) in_.fail("there is a second " + std::string(name));
    seen = true;
  }

  void read_points() {
    require_first(has_points_, "POINTS");
    const auto count = in_.count("the number of POINTS", 6);
    const auto& type = read_type();
    in_.rest_of_line();
    in_.plausible_count(count, "the number of POINTS", 3 * bytes_of(type));
    for (GlobalIndex i = 0; i < count; ++i) {
      Vec3d position{};
      for (auto& coordinate : position.components)
        coordinate = read_real(in_, type, binary_, swap_, "a coordinate of a point");
      grid_.points.push_back(position);
    }
  }

  void begin_cells() {
    if (!has_points_) in_.fail("CELLS come before POINTS");
    require_first(has_cells_, "CELLS");
    grid_.cells_position = in_.last_position();
  }

  std::int64_t read_point_of_cell(const VtkNumberType& type) {
    const auto point = integer(type, "a point of a cell");
    if (point < 0 || point >= static_cast<std::int64_t>(grid_.points.size()))
      in_.fail("there is no point " + std::to_string(point) + "; allowed are 0 to " +
               std::to_string(static_cast<std::int64_t>(grid_.points.size()) - 1));
    return point;
  }

  void read_cells() {
    begin_cells();
    const auto count = in_.count("the number of CELLS", 2);
    const auto numbers = in_.count("the size of CELLS", 2);
    in_.rest_of_line();
    const auto& type = *legacy_number_type("int");
    for (GlobalIndex cell = 0; cell < count; ++cell) {
      const auto points = in_.plausible_count(integer(type, "the number of points of a cell"),
                                              "the number of points of a cell", bytes_of(type));
      for (GlobalIndex i = 0; i < points; ++i) grid_.connectivity.push_back(read_point_of_cell(type));
      grid_.ends.push_back(static_cast<std::int64_t>(grid_.connectivity.size()));
    }
    const auto read = count + static_cast<GlobalIndex>(grid_.connectivity.size());
    if (read != numbers)
      in_.fail("the list of CELLS has " + std::to_string(read) + " numbers, but promises " +
               std::to_string(numbers));
  }

  /// CELLS, the number of offsets (one more than cells), the number of points of all cells; then two arrays.
  void read_offset_cells() {
    begin_cells();
    const auto offsets = in_.count("the number of OFFSETS", 2);
    const auto points = in_.count("the size of CONNECTIVITY", 2);
    if (in_.word("OFFSETS") != "OFFSETS") in_.fail("OFFSETS is expected here");
    const auto& offset_type = read_type();
    in_.rest_of_line();
    grid_.ends = integers(offset_type, offsets, "an offset");
    if (!grid_.ends.empty()) {
      if (grid_.ends.front() != 0) in_.fail("the first of the OFFSETS must be 0");
      grid_.ends.erase(grid_.ends.begin());
    }
    if (in_.word("CONNECTIVITY") != "CONNECTIVITY") in_.fail("CONNECTIVITY is expected here");
    const auto& point_type = read_type();
    in_.rest_of_line();
    for (GlobalIndex i = 0; i < points; ++i) grid_.connectivity.push_back(read_point_of_cell(point_type));
  }

  void read_cell_types() {
    require_first(has_types_, "CELL_TYPES");
    grid_.types_position = in_.last_position();
    const auto count = in_.count("the number of CELL_TYPES", 2);
    in_.rest_of_line();
    grid_.types = integers(*legacy_number_type("int"), count, "a cell type");
  }

  void begin_data(Owner owner, std::size_t expected) {
    const auto count = in_.integer("the number of data");
    if (count != static_cast<std::int64_t>(expected))
      in_.fail("there are data for " + std::to_string(count) + " of " + std::to_string(expected) +
               (owner == Owner::cells ? " cells" : " points"));
    owner_ = owner;
    tuples_ = count;
  }

  void skip_metadata() {
    in_.rest_of_line();
    while (!in_.rest_of_line().empty()) {
    }
  }

  /// FIELD name count; then as many arrays, each: name components tuples type.
  void read_field() {
    static_cast<void>(in_.word("the name of a field"));
    const auto arrays = in_.count("the number of arrays of a field", 8);
    for (GlobalIndex i = 0; i < arrays; ++i) {
      auto name = in_.word("the name of an array");
      if (name == "METADATA") {  // of the array before
        skip_metadata();
        name = in_.word("the name of an array");
      }
      const auto label = decoded(name);
      const auto components = in_.count("the number of components", 1);
      const auto tuples = in_.count("the number of tuples", 1);
      if (in_.peek_word() == "string") {
        in_.rest_of_line();
        in_.plausible_count(tuples, "the number of strings",
                            static_cast<std::size_t>(std::max<GlobalIndex>(components, 1)));
        read_strings(label, components * tuples);
      } else {
        const auto& type = read_type();
        in_.rest_of_line();
        read_array(label, type, components, tuples);
      }
    }
  }

  void read_strings(std::string_view name, GlobalIndex count) {
    for (GlobalIndex i = 0; i < count; ++i) {
      const auto text = decoded(binary_ ? read_binary_string() : in_.rest_of_line());
      if (name == region_names_array) grid_.region_names.push_back(text);
    }
  }

  /// The two highest bits of the first byte say how many bytes the length has: 11: 1, 10: 2, 01: 4, 00: 8.
  std::string_view read_binary_string() {
    constexpr std::string_view what = "the length of a string";
    auto length = std::uint64_t{in_.binary<std::uint8_t>(what, false)};
    const std::array<int, 4> more{7, 3, 1, 0};
    const int bytes = more[length >> 6U];
    length &= 63U;
    for (int i = 0; i < bytes; ++i) length = length << 8U | in_.binary<std::uint8_t>(what, false);
    return in_.bytes(length, "a string");
  }

  /// What a dataset's attribute is called, and how many numbers a tuple has.
  void read_attribute(const std::string& keyword) {
    if (keyword == "SCALARS") return read_scalars();
    if (keyword == "LOOKUP_TABLE" || keyword == "COLOR_SCALARS")
      return skip_colors(keyword == "LOOKUP_TABLE");
    GlobalIndex components = 0;
    if (keyword == "GLOBAL_IDS" || keyword == "PEDIGREE_IDS" || keyword == "EDGE_FLAGS") components = 1;
    if (keyword == "VECTORS" || keyword == "NORMALS") components = 3;
    if (keyword == "TENSORS") components = 9;
    if (keyword == "TENSORS6") components = 6;
    if (components == 0 && keyword != "TEXTURE_COORDINATES")
      in_.fail("'" + keyword.substr(0, 40) + "' is no keyword of VTK's that is read");
    const auto name = decoded(in_.word("the name of an array"));
    if (components == 0) components = in_.count("the number of components", 1);
    const auto& type = read_type();
    in_.rest_of_line();
    read_array(name, type, components, tuples_);
  }

  void read_scalars() {
    const auto name = decoded(in_.word("the name of an array"));
    const auto& type = read_type();
    const auto rest = in_.rest_of_line();
    const GlobalIndex components = rest.empty() ? 1 : rest.front() - '0';
    if (rest.size() > 1 || components < 1 || components > 4) in_.fail("scalars have 1 to 4 components");
    if (in_.peek_word() == "LOOKUP_TABLE") in_.rest_of_line();
    read_array(name, type, components, tuples_);
  }

  /// Colours: numbers from 0 to 1 as text, single bytes in binary files.
  void skip_colors(bool is_table) {
    static_cast<void>(in_.word("the name of an array"));
    const auto number = in_.count(is_table ? "the size of a table" : "the number of components", 1);
    in_.rest_of_line();
    const auto& type = *legacy_number_type("unsigned_char");
    is_table ? skip_array(type, 4, number) : skip_array(type, number, tuples_);
  }

  /// Keeps what makes regions and node sets, passes by the rest.
  void read_array(const std::string& name, const VtkNumberType& type, GlobalIndex components,
                  GlobalIndex tuples) {
    const bool numbers = components == 1 && type.kind != VtkNumberType::real;
    if (numbers && owner_ == Owner::cells && is_region_array(name) &&
        (grid_.regions.empty() || name == region_array)) {
      grid_.regions = integers(type, tuples, "the region of a cell");
    } else if (numbers && owner_ == Owner::points && name.starts_with(node_set_prefix)) {
      grid_.node_sets.emplace_back(name.substr(node_set_prefix.size()),
                                   integers(type, tuples, "a mark of a node"));
    } else if (owner_ == Owner::cells && !vectors_.found() && vectors_.meet(name, components, in_)) {
      read_vectors(type, tuples);
    } else {
      skip_array(type, components, tuples);
    }
  }

  void read_vectors(const VtkNumberType& type, GlobalIndex tuples) {
    in_.plausible_count(tuples, "the number of vectors", 3 * bytes_of(type));
    grid_.vectors.resize(static_cast<std::size_t>(tuples));
    for (auto& vector : grid_.vectors)
      for (auto& component : vector.components)
        component = read_real(in_, type, binary_, swap_, "a component of a vector");
  }

  void skip_array(const VtkNumberType& type, GlobalIndex components, GlobalIndex tuples) {
    if (components > 0)
      in_.plausible_count(tuples, "the size of an array",
                          bytes_of(type) * static_cast<std::size_t>(components));
    if (binary_) {
      static_cast<void>(in_.bytes(type.bytes * static_cast<std::size_t>(components * tuples), "an array"));
    } else {
      for (GlobalIndex i = 0; i < components * tuples; ++i)
        static_cast<void>(in_.word("a number of an array"));
    }
  }

  InputCursor& in_;
  VectorField& vectors_;
  VtkGrid grid_;
  double version_ = 0;
  bool binary_ = false;
  bool swap_ = std::endian::native == std::endian::little;  // binary files are big-endian
  Owner owner_ = Owner::grid;
  GlobalIndex tuples_ = 0;
  bool has_points_ = false;
  bool has_cells_ = false;
  bool has_types_ = false;
};

}  // namespace

Mesh read_vtk(InputCursor& in, VectorField& vectors) { return VtkReader(in, vectors).read(); }

}  // namespace evert
