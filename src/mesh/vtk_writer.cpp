#include "format_writers.hpp"
#include "vtk_grid.hpp"
#include <string>

/// Legacy VTK, ASCII, version 3: every reader knows it.
namespace evert {
namespace {

/// Names and strings stand between blanks, so VTK writes other characters as %20 and the like.
std::string encoded(std::string_view text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string result;
  for (const char c : text) {
    if (c > ' ' && c <= '~' && c != '%' && c != '"') {
      result += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    result += '%';
    result += digits[byte >> 4U];
    result += digits[byte & 15U];
  }
  return result;
}

void begin_scalars(OutputFile& out, std::string_view name, std::string_view type = "int") {
  out << "SCALARS " << encoded(name) << ' ' << type << " 1\nLOOKUP_TABLE default\n";
}

void write_cell_field(const CellField& field, OutputFile& out) {
  begin_scalars(out, field.name,
                std::holds_alternative<std::vector<double>>(field.values) ? "double" : "int");
  std::visit(
      [&](const auto& values) {
        for (const auto value : values) out << value << '\n';
      },
      field.values);
}

void write_node_set(const NodeSet& set, GlobalIndex nodes, OutputFile& out) {
  begin_scalars(out, std::string(node_set_prefix) + set.name);
  auto next = set.nodes.begin();
  for (GlobalIndex node = 0; node < nodes; ++node) {
    const bool member = next != set.nodes.end() && *next == node;
    out << (member ? "1\n" : "0\n");
    if (member) ++next;
  }
}

void write_vectors(std::span<const Vec3d> vectors, OutputFile& out) {
  for (const auto& vector : vectors) out << vector[0] << ' ' << vector[1] << ' ' << vector[2] << '\n';
}

void write_cells(const Mesh& mesh, OutputFile& out) {
  std::int64_t numbers = mesh.cell_count();
  for (const auto& block : mesh.cells) numbers += static_cast<std::int64_t>(block.nodes.size());
  out << "CELLS " << mesh.cell_count() << ' ' << numbers << '\n';
  for (const auto& block : mesh.cells) {
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    for (std::size_t first = 0; first < block.nodes.size(); first += stride) {
      out << node_count(block.type);
      for (std::size_t i = 0; i < stride; ++i) out << ' ' << block.nodes[first + i];
      out << '\n';
    }
  }
  out << "CELL_TYPES " << mesh.cell_count() << '\n';
  for (const auto& block : mesh.cells)
    for (GlobalIndex cell = 0; cell < block.size(); ++cell) out << vtk_number(block.type) << '\n';
}

}  // namespace

void write_vtk(const Mesh& mesh, std::span<const CellField> fields, std::span<const NodeVectors> vectors,
               OutputFile& out) {
  out << "# vtk DataFile Version 3.0\nEvert mesh\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  out << "FIELD FieldData 1\n"
      << region_names_array << " 1 " << static_cast<std::int64_t>(mesh.regions.size()) << " string\n";
  for (const auto& name : mesh.regions) out << encoded(name) << '\n';
  out << "POINTS " << mesh.node_count() << " double\n";
  write_vectors(mesh.nodes, out);
  write_cells(mesh, out);

  out << "CELL_DATA " << mesh.cell_count() << '\n';
  begin_scalars(out, region_array);
  for (const auto& block : mesh.cells)
    for (const auto region : block.region) out << region << '\n';
  for (const auto& field : fields) write_cell_field(field, out);
  if (mesh.node_sets.empty() && vectors.empty()) return;
  out << "POINT_DATA " << mesh.node_count() << '\n';
  for (const auto& set : mesh.node_sets) write_node_set(set, mesh.node_count(), out);
  for (const auto& field : vectors) {
    out << "VECTORS " << encoded(field.name) << " double\n";
    write_vectors(field.values, out);
  }
}

}  // namespace evert
