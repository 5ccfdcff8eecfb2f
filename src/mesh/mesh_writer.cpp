#include "evert/mesh/mesh_writer.hpp"

#include "evert/core/error.hpp"

#include "format_writers.hpp"
#include <algorithm>

namespace evert {
namespace {

GlobalIndex size_of(const CellField& field) {
  return std::visit([](const auto& values) { return static_cast<GlobalIndex>(values.size()); }, field.values);
}

}  // namespace

MeshFormat mesh_format_of(const std::filesystem::path& path) {
  const auto extension = path.extension().string();
  if (extension == ".msh") return MeshFormat::gmsh41;
  if (extension == ".mesh") return MeshFormat::medit;
  if (extension == ".vtk") return MeshFormat::vtk;
  if (extension == ".vtu") return MeshFormat::vtu;
  throw UserError(path.string() + ": the extension must be .msh (Gmsh), .mesh (Medit), .vtk or .vtu, not '" +
                  extension + "'");
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& path, MeshFormat format,
                std::span<const CellField> fields, std::span<const NodeVectors> vectors) {
  if (!(fields.empty() && vectors.empty()) && format != MeshFormat::vtk && format != MeshFormat::vtu)
    throw UserError(path.string() + ": cell fields can be written to .vtk and .vtu files only");
  for (const auto& field : fields) EVERT_ASSERT(size_of(field) == mesh.cell_count(), field.name);
  for (const auto& field : vectors)
    EVERT_ASSERT(static_cast<GlobalIndex>(field.values.size()) == mesh.node_count(), field.name);
  OutputFile out(path);
  switch (format) {
    case MeshFormat::gmsh41:
      write_gmsh41(mesh, out);
      break;
    case MeshFormat::gmsh22:
      write_gmsh22(mesh, out);
      break;
    case MeshFormat::medit:
      write_medit(mesh, out);
      break;
    case MeshFormat::vtk:
      write_vtk(mesh, fields, vectors, out);
      break;
    case MeshFormat::vtu:
      write_vtu(mesh, fields, vectors, out);
      break;
  }
  out.commit();
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& path, std::span<const CellField> fields) {
  write_mesh(mesh, path, mesh_format_of(path), fields);
}

std::string what_is_lost(const Mesh& mesh, MeshFormat format) {
  if (format != MeshFormat::medit) return "";
  const bool renamed =
      std::ranges::any_of(mesh.regions, [](const auto& name) { return !name.starts_with("ref_"); });
  std::string lost;
  if (renamed) lost += "Medit has no names: regions become references 1, 2, ... in their order";
  if (!mesh.node_sets.empty())
    lost += lost.empty() ? "Medit has no node sets: they are left out" : ", node sets are left out";
  return lost;
}

}  // namespace evert
