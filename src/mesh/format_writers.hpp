#pragma once
#include "evert/mesh/mesh.hpp"
#include "evert/mesh/mesh_writer.hpp"

#include "output_file.hpp"
#include <span>
#include <string_view>

/// One writer per file format; write_mesh chooses.
namespace evert {

void write_gmsh41(const Mesh& mesh, OutputFile& out);
void write_gmsh22(const Mesh& mesh, OutputFile& out);
void write_medit(const Mesh& mesh, OutputFile& out);
void write_vtk(const Mesh& mesh, std::span<const CellField> fields, std::span<const NodeVectors> vectors,
               OutputFile& out);
void write_vtu(const Mesh& mesh, std::span<const CellField> fields, std::span<const NodeVectors> vectors,
               OutputFile& out);

}  // namespace evert
