#include "base64.hpp"
#include "format_writers.hpp"
#include "vtk_grid.hpp"
#include <bit>
#include <cstring>

/// VTU with inline base64, the form that every VTK and ParaView reads.
namespace evert {
namespace {

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

template <class T>
constexpr std::string_view type_name() {
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
}

template <class T>
void write_array(OutputFile& out, std::string_view name, std::span<const T> values, int components = 1) {
  const auto size = static_cast<std::uint64_t>(values.size_bytes());
  std::string bytes(sizeof(size) + size, '\0');
  std::memcpy(bytes.data(), &size, sizeof(size));
  if (size > 0) std::memcpy(bytes.data() + sizeof(size), values.data(), size);
  out << "<DataArray type=\"" << type_name<T>() << "\" Name=\"" << escaped(name) << "\" NumberOfComponents=\""
      << components << "\" format=\"binary\">\n"
      << to_base64(bytes) << "\n</DataArray>\n";
}

std::vector<double> flattened(std::span<const Vec3d> vectors) {
  std::vector<double> values;
  values.reserve(3 * vectors.size());
  for (const auto& vector : vectors)
    values.insert(values.end(), vector.components.begin(), vector.components.end());
  return values;
}

void write_region_names(const Mesh& mesh, OutputFile& out) {
  out << "<FieldData>\n<DataArray type=\"String\" Name=\"" << region_names_array << "\" NumberOfTuples=\""
      << static_cast<std::int64_t>(mesh.regions.size()) << "\" format=\"ascii\">\n";
  for (const auto& name : mesh.regions) {
    for (const char c : name) out << static_cast<int>(static_cast<unsigned char>(c)) << ' ';
    out << "0\n";
  }
  out << "</DataArray>\n</FieldData>\n";
}

void write_cells(const Mesh& mesh, OutputFile& out) {
  std::vector<std::int64_t> connectivity;
  std::vector<std::int64_t> ends;
  std::vector<std::uint8_t> types;
  for (const auto& block : mesh.cells) {
    auto end = static_cast<std::int64_t>(connectivity.size());
    connectivity.insert(connectivity.end(), block.nodes.begin(), block.nodes.end());
    for (GlobalIndex cell = 0; cell < block.size(); ++cell) ends.push_back(end += node_count(block.type));
    types.insert(types.end(), block.region.size(), static_cast<std::uint8_t>(vtk_number(block.type)));
  }
  out << "<Cells>\n";
  write_array<std::int64_t>(out, "connectivity", connectivity);
  write_array<std::int64_t>(out, "offsets", ends);
  write_array<std::uint8_t>(out, "types", types);
  out << "</Cells>\n";
}

void write_cell_data(const Mesh& mesh, std::span<const CellField> fields, OutputFile& out) {
  std::vector<std::int32_t> regions;
  for (const auto& block : mesh.cells)
    regions.insert(regions.end(), block.region.begin(), block.region.end());
  out << "<CellData>\n";
  write_array<std::int32_t>(out, region_array, regions);
  for (const auto& field : fields)
    std::visit(
        [&](const auto& values) {
          write_array<typename std::decay_t<decltype(values)>::value_type>(out, field.name, values);
        },
        field.values);
  out << "</CellData>\n";
}

void write_point_data(const Mesh& mesh, std::span<const NodeVectors> vectors, OutputFile& out) {
  out << "<PointData>\n";
  for (const auto& set : mesh.node_sets) {
    std::vector<std::uint8_t> members(mesh.nodes.size(), 0);
    for (const auto node : set.nodes) members[static_cast<std::size_t>(node)] = 1;
    write_array<std::uint8_t>(out, std::string(node_set_prefix) + set.name, members);
  }
  for (const auto& field : vectors) write_array<double>(out, field.name, flattened(field.values), 3);
  out << "</PointData>\n";
}

}  // namespace

void write_vtu(const Mesh& mesh, std::span<const CellField> fields, std::span<const NodeVectors> vectors,
               OutputFile& out) {
  const bool little = std::endian::native == std::endian::little;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
      << (little ? "LittleEndian" : "BigEndian") << "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n";
  write_region_names(mesh, out);
  out << "<Piece NumberOfPoints=\"" << mesh.node_count() << "\" NumberOfCells=\"" << mesh.cell_count()
      << "\">\n";
  write_point_data(mesh, vectors, out);
  write_cell_data(mesh, fields, out);
  out << "<Points>\n";
  write_array<double>(out, "Points", flattened(mesh.nodes), 3);
  out << "</Points>\n";
  write_cells(mesh, out);
  out << "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace evert
