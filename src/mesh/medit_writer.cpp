#include "format_writers.hpp"
#include <charconv>
#include <optional>

namespace evert {
namespace {

std::string_view keyword(CellType type) {
  switch (type) {
    case CellType::tet4:
      return "Tetrahedra";
    case CellType::hex8:
      return "Hexahedra";
    case CellType::wedge6:
      return "Prisms";
    case CellType::tet10:
      return "TetrahedraP2";
  }
  return "";
}

/// The number of a region called "ref_<number>" by the reader.
std::optional<std::int64_t> reference_in(std::string_view name) {
  constexpr std::string_view prefix = "ref_";
  if (!name.starts_with(prefix)) return {};
  name.remove_prefix(prefix.size());
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc{} || end != name.data() + name.size()) return {};
  return number;
}

/// References of the regions: their own, when all have one, else 1, 2, ...
std::vector<std::int64_t> references_of(const Mesh& mesh) {
  std::vector<std::int64_t> own;
  std::vector<std::int64_t> counted;
  for (const auto& name : mesh.regions) {
    if (const auto reference = reference_in(name)) own.push_back(*reference);
    counted.push_back(static_cast<std::int64_t>(counted.size()) + 1);
  }
  return own.size() == counted.size() ? own : counted;
}

}  // namespace

void write_medit(const Mesh& mesh, OutputFile& out) {
  const auto references = references_of(mesh);
  out << "MeshVersionFormatted 2\nDimension 3\nVertices\n" << mesh.node_count() << '\n';
  for (const auto& position : mesh.nodes)
    out << position[0] << ' ' << position[1] << ' ' << position[2] << " 0\n";
  for (const auto& block : mesh.cells) {
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    out << keyword(block.type) << '\n' << block.size() << '\n';
    for (std::size_t cell = 0; cell < block.region.size(); ++cell) {
      for (std::size_t i = 0; i < stride; ++i) out << block.nodes[stride * cell + i] + 1 << ' ';
      out << references[static_cast<std::size_t>(block.region[cell])] << '\n';
    }
  }
  out << "End\n";
}

}  // namespace evert
