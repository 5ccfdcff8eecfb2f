#pragma once
#include "evert/mesh/mesh.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace evert {

enum class MeshFormat {
  gmsh41,  ///< Gmsh 4.1 ASCII: regions and node sets are physical groups
  gmsh22,  ///< Gmsh 2.2 ASCII: the same
  medit,   ///< Medit ASCII: regions are references, node sets are lost
  vtk,     ///< legacy VTK ASCII: cell array "region", point arrays "node_set:<name>", field "region_names"
  vtu,     ///< VTK XML, inline base64: the same
};

/// The format that a file name's extension asks for: .msh (4.1), .mesh, .vtk, .vtu. Throws UserError for
/// others.
[[nodiscard]] MeshFormat mesh_format_of(const std::filesystem::path& path);

/// A number per cell to be written along, all blocks in order.
struct CellField {
  std::string name;
  std::variant<std::vector<std::int32_t>, std::vector<double>> values;
};

/// A vector per node to be written along.
struct NodeVectors {
  std::string name;
  std::vector<Vec3d> values;
};

/// Writes the mesh such that read_mesh gives it back: same numbers to the last bit, same order. The file
/// appears under its name only once it is complete. Not collective. Throws UserError when it cannot be
/// written (no folder, no permission, disk full), or when `fields` or `vectors` are given for a format
/// that cannot hold them (all but VTK's).
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, MeshFormat format,
                std::span<const CellField> fields = {}, std::span<const NodeVectors> vectors = {});
/// The same in the format of the extension.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, std::span<const CellField> fields = {});

/// What a format cannot hold of this mesh, as a sentence for the user; "" when nothing is lost.
[[nodiscard]] std::string what_is_lost(const Mesh& mesh, MeshFormat format);

}  // namespace evert
