#include "evert/app/mesh_command.hpp"

#include "evert/app/command_line.hpp"
#include "evert/core/error.hpp"
#include "evert/mesh/mesh_reader.hpp"
#include "evert/mesh/mesh_writer.hpp"
#include "evert/mesh/partition.hpp"
#include "evert/mesh/partition_quality.hpp"
#include "evert/mesh/quality.hpp"
#include "evert/mesh/repair.hpp"

#include "command_options.hpp"
#include "mesh_shapes.hpp"
#include <fstream>
#include <iomanip>
#include <vector>

namespace evert {
namespace {

constexpr const char* help = R"(evert mesh: makes, converts, judges and partitions meshes

evert mesh generate SHAPE ... -o OUT     make a mesh and print its quality; lengths in metres
  box          -size X,Y,Z (-edge_length E | -cells NX,NY,NZ [-hole NX,NY | -cross N]) [-cell bcc|tet5|tet6|hex8|wedge6]
  The others take -edge_length E, and the keys that the same shape has in a scene ('evert explain bodies.mesh'):
  ball         -radius R
  rounded_box  -size X,Y,Z -rounding R
  ellipsoid    -radii A,B,C
  capsule      -radius R -length L
  cylinder     -radius R -length L
  torus        -major_radius R -minor_radius R
  cone         -bottom_radius R [-top_radius R] -length L
  gear         -teeth N -root_radius R -tip_radius R -width W
  figure       [-height H]
  mesh         -surface FILE [-scale S]     what a closed surface (.obj, .stl, .ply, .off) encloses
  union, intersection, difference   -of '[{shape: ..., ...}, ...]'
  round_bar    -radius R -length L [-inner_radius R] [-quarter N] [-rings N] [-layers N]     hexahedra, no -edge_length
  With bad elements, for the modal filter:
  wedge_stack  [-edge_length E] [-edge_ratio R] [-layers N]
  cut_cube     [-size S] [-cells N] [-normal X,Y,Z] [-through X,Y,Z] [-snap S]
  sliver_ball  -radius R [-slivers SHARE] [-jitter J] [-thinnest T] [-seed N]
evert mesh convert IN OUT [options]      read any format, write another
  -reorient                              mirror the cells of negative volume
  -drop_unused                           leave out nodes that no cell uses
  -gmsh22                                write Gmsh 2.2 instead of 4.1
evert mesh quality IN [-json FILE]       report on a mesh: angles, volumes, faults
evert mesh partition IN -ranks N [-o OUT]
                                         balance and cut of METIS's partition; OUT (.vtu, .vtk) shows it as 'rank'

Read: Gmsh 2.2 and 4.1 (.msh), Medit (.mesh), VTK (.vtk, .vtu), TetGen (.node with .ele).
Written, by the extension: .msh, .mesh, .vtk, .vtu.

Examples:
  evert mesh generate torus -major_radius 0.5 -minor_radius 0.2 -edge_length 0.077 -o torus.msh
  evert mesh generate difference -of '[{shape: box, size: [1, 1, 1]}, {shape: sphere, radius: 0.6}]' \\
                      -edge_length 0.05 -o drilled.msh
  evert mesh generate box -size 1,0.2,0.2 -cells 50,10,10 -cell hex8 -o beam.vtu
  evert mesh convert scan.mesh scan.msh -reorient -drop_unused
  evert mesh quality scan.msh -json quality.json
  evert mesh partition scan.msh -ranks 8 -o ranks.vtu
)";

void write_and_tell(const Mesh& mesh, const std::string& path, MeshFormat format, std::ostream& out) {
  write_mesh(mesh, path, format);
  if (const auto lost = what_is_lost(mesh, format); !lost.empty()) out << "note: " << lost << '\n';
  out << "wrote " << path << ": " << mesh.node_count() << " nodes, " << mesh.cell_count() << " cells\n";
}

int generate_command(std::span<const std::string> arguments, std::ostream& out) {
  const auto request = generate_mesh(arguments);
  write_quality_text(measure_quality(request.mesh), out);
  write_and_tell(request.mesh, request.output, request.format, out);
  return 0;
}

int convert_command(std::span<const std::string> arguments, std::ostream& out) {
  const CommandOptions options("evert mesh convert", arguments, {}, {"reorient", "drop_unused", "gmsh22"},
                               {"a mesh to read", "a file to write"});
  auto format = mesh_format_of(options.file(1));
  if (options.has("gmsh22")) {
    if (format != MeshFormat::gmsh41) throw UserError("evert mesh convert: -gmsh22 is for .msh files only");
    format = MeshFormat::gmsh22;
  }
  auto mesh = read_mesh(options.file(0));
  if (options.has("reorient")) out << "reoriented " << reorient(mesh) << " cells\n";
  if (options.has("drop_unused")) out << "dropped " << drop_unused_nodes(mesh) << " unused nodes\n";
  write_and_tell(mesh, options.file(1), format, out);
  return 0;
}

int quality_command(std::span<const std::string> arguments, std::ostream& out) {
  const CommandOptions options("evert mesh quality", arguments, {"json"}, {}, {"a mesh to read"});
  const auto quality = measure_quality(read_mesh(options.file(0)));
  write_quality_text(quality, out);
  if (!options.has("json")) return 0;
  const auto path = options.text("json");
  std::ofstream file(path);
  write_quality_json(quality, file);
  if (!file.flush()) throw UserError(path + ": cannot be written");
  out << "wrote " << path << '\n';
  return 0;
}

void write_partition(const PartitionQuality& quality, std::ostream& out) {
  out << "  rank       cells        work       nodes   cut faces  neighbours\n";
  for (std::size_t rank = 0; rank < quality.ranks.size(); ++rank) {
    const auto& load = quality.ranks[rank];
    out << std::setw(6) << rank << std::setw(12) << load.cells << std::setw(12) << load.work << std::setw(12)
        << load.nodes << std::setw(12) << load.cut_faces << std::setw(12) << load.neighbours.size() << '\n';
  }
  out << "edge cut " << quality.edge_cut << " faces, imbalance " << std::setprecision(4) << quality.imbalance
      << " (largest work over the mean)\n";
}

int partition_command(std::span<const std::string> arguments, std::ostream& out) {
  const CommandOptions options("evert mesh partition", arguments, {"ranks", "o"}, {}, {"a mesh to read"});
  const int ranks = options.whole_number("ranks");
  if (ranks < 1)
    throw UserError("evert mesh partition: -ranks must be at least 1, not " + std::to_string(ranks));
  const auto mesh = read_mesh(options.file(0));
  const auto rank_of_cell = partition_cells(mesh, ranks);
  write_partition(measure_partition(mesh, rank_of_cell, ranks), out);
  if (!options.has("o")) return 0;
  const std::vector<CellField> fields{
      {"rank", std::vector<std::int32_t>(rank_of_cell.begin(), rank_of_cell.end())}};
  write_mesh(mesh, options.text("o"), fields);
  out << "wrote " << options.text("o") << '\n';
  return 0;
}

}  // namespace

int mesh_command(std::span<const std::string> arguments, std::ostream& out) {
  const std::vector<std::string> commands{"generate", "convert", "quality", "partition"};
  if (asks_for_help(arguments)) {
    out << help;
    return 0;
  }
  if (arguments.empty())
    throw UserError("evert mesh needs a command: " + list_of(commands) + "; see evert mesh --help");
  const auto& command = arguments.front();
  const auto rest = arguments.subspan(1);
  if (command == "generate") return generate_command(rest, out);
  if (command == "convert") return convert_command(rest, out);
  if (command == "quality") return quality_command(rest, out);
  if (command == "partition") return partition_command(rest, out);
  throw UserError("evert mesh: there is no command '" + command + "': must be " + list_of(commands) +
                  did_you_mean(command, commands));
}

}  // namespace evert
