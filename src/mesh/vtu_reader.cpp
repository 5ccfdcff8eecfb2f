#include "format_readers.hpp"
#include "vtk_grid.hpp"
#include "vtu_data.hpp"
#include "xml_scanner.hpp"
#include <bit>
#include <charconv>
#include <string>
#include <vector>

/// VTK's XML format for unstructured grids: text, inline base64 and appended data, compressed by zlib or not.
namespace evert {
namespace {

/// The arrays of one <Piece>, by section.
struct Piece {
  std::size_t position = 0;
  std::size_t points = 0;
  std::size_t cells = 0;
  std::vector<VtuArray> point_data;
  std::vector<VtuArray> cell_data;
  std::vector<VtuArray> coordinates;
  std::vector<VtuArray> topology;  // connectivity, offsets, types
};

class VtuReader {
 public:
  VtuReader(InputCursor& in, VectorField& vectors) : in_(in), vectors_(vectors), scanner_(in) {}

  Mesh read() {
    scan();
    for (const auto& array : field_data_)
      if (array.tag.attribute("Name") == region_names_array)
        grid_.region_names = vtu_strings(array, encoding_, in_);
    for (const auto& piece : pieces_) add(piece);
    if (pieces_.empty()) in_.fail_at(0, "the file has no <Piece>");
    vectors_.expect_found(in_.name());
    return mesh_of(grid_, in_);
  }

 private:
  /// Collects the arrays; they are decoded afterwards, as appended data stands at the end.
  void scan() {
    read_head(scanner_.next());
    std::vector<VtuArray>* section = nullptr;
    while (true) {
      auto tag = scanner_.next();
      if (tag.name == "AppendedData" && tag.kind == XmlTag::start) return read_appended(tag);
      if (tag.name == "VTKFile" && tag.kind == XmlTag::end) return;
      if (tag.name == "Piece" && tag.kind == XmlTag::start) begin_piece(tag);
      if (tag.name == "FieldData") section = &field_data_;
      if (!pieces_.empty()) {
        auto& piece = pieces_.back();
        if (tag.name == "PointData") section = &piece.point_data;
        if (tag.name == "CellData") section = &piece.cell_data;
        if (tag.name == "Points") section = &piece.coordinates;
        if (tag.name == "Cells") section = &piece.topology;
      }
      const bool array = tag.name == "DataArray" || tag.name == "Array";
      if (!array || tag.kind == XmlTag::end || section == nullptr) continue;
      const bool empty = tag.kind == XmlTag::empty;
      section->push_back({std::move(tag), empty ? std::string_view{} : scanner_.text()});
    }
  }

  void read_head(const XmlTag& tag) {
    if (tag.name != "VTKFile") in_.fail_at(tag.position, "a VTU file must begin with <VTKFile>");
    const auto kind = tag.attribute("type");
    if (kind != "UnstructuredGrid")
      in_.fail_at(tag.position, "VTK files of type '" + kind + "' are not read; allowed is UnstructuredGrid");
    const auto order = tag.attribute("byte_order", "LittleEndian");
    if (order != "LittleEndian" && order != "BigEndian")
      in_.fail_at(tag.position, "byte_order must be LittleEndian or BigEndian, not '" + order + "'");
    encoding_.swap = (order == "LittleEndian") != (std::endian::native == std::endian::little);
    const auto header = tag.attribute("header_type", "UInt32");
    if (header != "UInt32" && header != "UInt64")
      in_.fail_at(tag.position, "header_type must be UInt32 or UInt64, not '" + header + "'");
    encoding_.header_bytes = header == "UInt64" ? 8 : 4;
    const auto compressor = tag.attribute("compressor");
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      in_.fail_at(tag.position,
                  "data compressed by '" + compressor + "' are not read; allowed is vtkZLibDataCompressor");
    encoding_.compressed = !compressor.empty();
  }

  void begin_piece(const XmlTag& tag) {
    pieces_.emplace_back();
    pieces_.back().position = tag.position;
    pieces_.back().points = count(tag, "NumberOfPoints");
    pieces_.back().cells = count(tag, "NumberOfCells");
  }

  std::size_t count(const XmlTag& tag, std::string_view name) const {
    const auto text = tag.attribute(name);
    std::size_t value = 0;
    const auto end = text.data() + text.size();
    if (text.empty() || std::from_chars(text.data(), end, value).ptr != end)
      in_.fail_at(tag.position, "<Piece> must have a whole number as " + std::string(name));
    return value;
  }

  void read_appended(const XmlTag& tag) {
    const auto encoding = tag.attribute("encoding", "base64");
    if (encoding != "raw" && encoding != "base64")
      in_.fail_at(tag.position, "appended data must be encoded as raw or base64, not as '" + encoding + "'");
    encoding_.appended_is_base64 = encoding == "base64";
    const auto rest = in_.rest();
    const auto begin = rest.find('_');
    const auto end = rest.rfind("</AppendedData>");
    if (begin == std::string_view::npos || end == std::string_view::npos || end < begin)
      in_.fail_at(tag.position,
                  "the appended data must begin with '_' and end with </AppendedData> (truncated?)");
    if (rest.find("</VTKFile>", end) == std::string_view::npos)
      in_.fail_at(in_.position() + rest.size(), "the file ends where </VTKFile> is expected (truncated?)");
    encoding_.appended = rest.substr(begin + 1, end - begin - 1);
  }

  const VtuArray& find(const Piece& piece, const std::vector<VtuArray>& arrays, std::string_view name) const {
    for (const auto& array : arrays)
      if (array.tag.attribute("Name") == name) return array;
    in_.fail_at(piece.position, "the <Piece> has no array '" + std::string(name) + "'");
  }

  /// Throws unless an array of this name has as many numbers as the piece promises.
  void expect(const VtuArray& array, std::size_t size, std::size_t expected) const {
    if (size != expected)
      in_.fail_at(array.tag.position, "the array '" + array.tag.attribute("Name") + "' has " +
                                          std::to_string(size) + " numbers, but must have " +
                                          std::to_string(expected));
  }

  void add(const Piece& piece) {
    const auto first_point = static_cast<std::int64_t>(grid_.points.size());
    const auto first_entry = static_cast<std::int64_t>(grid_.connectivity.size());
    const auto first_cell = grid_.types.size();
    add_points(piece);

    const auto& connectivity = find(piece, piece.topology, "connectivity");
    const auto& offsets = find(piece, piece.topology, "offsets");
    const auto& types = find(piece, piece.topology, "types");
    grid_.cells_position = connectivity.tag.position;
    grid_.types_position = types.tag.position;
    for (const auto point : vtu_integers(connectivity, encoding_, in_, "a point of a cell")) {
      if (point < 0 || point >= static_cast<std::int64_t>(piece.points))
        in_.fail_at(connectivity.tag.position, "there is no point " + std::to_string(point) +
                                                   "; the piece has " + std::to_string(piece.points) +
                                                   ", counted from 0");
      grid_.connectivity.push_back(first_point + point);
    }
    const auto ends = vtu_integers(offsets, encoding_, in_, "an offset");
    expect(offsets, ends.size(), piece.cells);
    for (const auto end : ends) {
      if (end < 0 || end > static_cast<std::int64_t>(grid_.connectivity.size()) - first_entry)
        in_.fail_at(offsets.tag.position,
                    "the offset " + std::to_string(end) + " is outside the connectivity");
      grid_.ends.push_back(first_entry + end);
    }
    const auto numbers = vtu_integers(types, encoding_, in_, "a cell type");
    expect(types, numbers.size(), piece.cells);
    grid_.types.insert(grid_.types.end(), numbers.begin(), numbers.end());

    add_regions(piece, first_cell);
    if (vectors_.wanted()) add_vectors(piece);
    add_node_sets(piece, static_cast<std::size_t>(first_point));
  }

  void add_points(const Piece& piece) {
    if (piece.coordinates.empty()) in_.fail_at(piece.position, "the <Piece> has no array in <Points>");
    const auto& array = piece.coordinates.front();
    const auto values = vtu_reals(array, encoding_, in_, "a coordinate of a point");
    if (piece.points > values.size()) expect(array, values.size(), piece.points);
    expect(array, values.size(), 3 * piece.points);
    for (std::size_t i = 0; i < values.size(); i += 3)
      grid_.points.push_back({values[i], values[i + 1], values[i + 2]});
  }

  void add_regions(const Piece& piece, std::size_t first_cell) {
    const VtuArray* chosen = nullptr;
    for (const auto& array : piece.cell_data) {
      const auto name = array.tag.attribute("Name");
      if (is_region_array(name) && array.tag.attribute("type").find("Int") != std::string::npos &&
          (chosen == nullptr || name == region_array))
        chosen = &array;
    }
    if (chosen == nullptr) {
      if (!grid_.regions.empty()) grid_.regions.resize(grid_.types.size(), 0);
      return;
    }
    const auto regions = vtu_integers(*chosen, encoding_, in_, "the region of a cell");
    expect(*chosen, regions.size(), piece.cells);
    grid_.regions.resize(first_cell, 0);
    grid_.regions.insert(grid_.regions.end(), regions.begin(), regions.end());
  }

  /// Pieces without the field leave their cells without vectors: mesh_of counts them.
  void add_vectors(const Piece& piece) {
    for (const auto& array : piece.cell_data) {
      const auto components = array.tag.attribute("NumberOfComponents", "1");
      if (!vectors_.meet(array.tag.attribute("Name"), components == "3" ? 3 : 1, in_)) continue;
      const auto values = vtu_reals(array, encoding_, in_, "a component of a vector");
      expect(array, values.size(), 3 * piece.cells);
      for (std::size_t i = 0; i < values.size(); i += 3)
        grid_.vectors.push_back({values[i], values[i + 1], values[i + 2]});
      return;
    }
  }

  void add_node_sets(const Piece& piece, std::size_t first_point) {
    for (const auto& array : piece.point_data) {
      const auto name = array.tag.attribute("Name");
      if (!name.starts_with(node_set_prefix)) continue;
      auto members = vtu_integers(array, encoding_, in_, "a mark of a node");
      expect(array, members.size(), piece.points);
      members.insert(members.begin(), first_point, 0);
      grid_.node_sets.emplace_back(name.substr(node_set_prefix.size()), std::move(members));
    }
    for (auto& [name, members] : grid_.node_sets) members.resize(grid_.points.size(), 0);
  }

  InputCursor& in_;
  VectorField& vectors_;
  XmlScanner scanner_;
  VtuEncoding encoding_;
  std::vector<VtuArray> field_data_;
  std::vector<Piece> pieces_;
  VtkGrid grid_;
};

}  // namespace

Mesh read_vtu(InputCursor& in, VectorField& vectors) { return VtuReader(in, vectors).read(); }

}  // namespace evert
