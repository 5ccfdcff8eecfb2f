#include "format_writers.hpp"
#include <algorithm>
#include <array>

/// Regions are written as physical volumes 1, 2, ..., node sets as physical points 1, 2, ..., each with one
/// entity of the same number. Tags are numbers + 1.
namespace evert {
namespace {

int gmsh_type(CellType type) {
  switch (type) {
    case CellType::tet4:
      return 4;
    case CellType::hex8:
      return 5;
    case CellType::wedge6:
      return 6;
    case CellType::tet10:
      return 11;
  }
  return 0;
}
constexpr int point_type = 15;

/// Gmsh's names end with the line.
std::string on_one_line(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '_');
  return name;
}

void write_names(const Mesh& mesh, OutputFile& out) {
  out << "$PhysicalNames\n" << static_cast<std::int64_t>(mesh.regions.size() + mesh.node_sets.size()) << '\n';
  for (std::size_t i = 0; i < mesh.node_sets.size(); ++i)
    out << "0 " << static_cast<std::int64_t>(i + 1) << " \"" << on_one_line(mesh.node_sets[i].name) << "\"\n";
  for (std::size_t i = 0; i < mesh.regions.size(); ++i)
    out << "3 " << static_cast<std::int64_t>(i + 1) << " \"" << on_one_line(mesh.regions[i]) << "\"\n";
  out << "$EndPhysicalNames\n";
}

void write_position(const Vec3d& position, OutputFile& out) {
  out << position[0] << ' ' << position[1] << ' ' << position[2];
}

void write_cell_nodes(const CellBlock& block, std::size_t cell, OutputFile& out) {
  const auto stride = static_cast<std::size_t>(node_count(block.type));
  std::array<GlobalIndex, 10> nodes{};
  std::copy_n(block.nodes.begin() + static_cast<std::ptrdiff_t>(stride * cell), stride, nodes.begin());
  if (block.type == CellType::tet10)
    std::swap(nodes[8], nodes[9]);  // Gmsh: edges (2,3), (1,3); VTK: (1,3), (2,3)
  for (std::size_t i = 0; i < stride; ++i) out << ' ' << nodes[i] + 1;
  out << '\n';
}

/// Cells of one block that follow each other in one region.
struct Run {
  const CellBlock* block;
  std::size_t begin;
  std::size_t end;
};

std::vector<Run> runs_of(const Mesh& mesh) {
  std::vector<Run> runs;
  for (const auto& block : mesh.cells)
    for (std::size_t begin = 0; begin < block.region.size();) {
      auto end = begin;
      while (end < block.region.size() && block.region[end] == block.region[begin]) ++end;
      runs.push_back({&block, begin, end});
      begin = end;
    }
  return runs;
}

std::int64_t element_count(const Mesh& mesh) {
  std::int64_t count = mesh.cell_count();
  for (const auto& set : mesh.node_sets) count += static_cast<std::int64_t>(set.nodes.size());
  return count;
}

void write_entities(const Mesh& mesh, OutputFile& out) {
  Vec3d lower{};
  Vec3d upper{};
  if (!mesh.nodes.empty()) lower = upper = mesh.nodes.front();
  for (const auto& node : mesh.nodes)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], node[axis]);
      upper[axis] = std::max(upper[axis], node[axis]);
    }
  out << "$Entities\n"
      << static_cast<std::int64_t>(mesh.node_sets.size()) << " 0 0 "
      << static_cast<std::int64_t>(mesh.regions.size()) << '\n';
  for (std::size_t i = 0; i < mesh.node_sets.size(); ++i) {
    const auto& nodes = mesh.node_sets[i].nodes;
    const auto number = static_cast<std::int64_t>(i + 1);
    out << number << ' ';
    write_position(nodes.empty() ? lower : mesh.nodes[static_cast<std::size_t>(nodes.front())], out);
    out << " 1 " << number << '\n';
  }
  for (std::size_t i = 0; i < mesh.regions.size(); ++i) {
    const auto number = static_cast<std::int64_t>(i + 1);
    out << number << ' ';
    write_position(lower, out);
    out << ' ';
    write_position(upper, out);
    out << " 1 " << number << " 0\n";
  }
  out << "$EndEntities\n";
}

void write_elements41(const Mesh& mesh, OutputFile& out) {
  const auto runs = runs_of(mesh);
  const auto total = element_count(mesh);
  const auto sets = static_cast<std::int64_t>(
      std::ranges::count_if(mesh.node_sets, [](const NodeSet& set) { return !set.nodes.empty(); }));
  out << "$Elements\n"
      << static_cast<std::int64_t>(runs.size()) + sets << ' ' << total << " 1 " << total << '\n';
  std::int64_t tag = 0;
  for (std::size_t i = 0; i < mesh.node_sets.size(); ++i) {
    const auto& nodes = mesh.node_sets[i].nodes;
    if (nodes.empty()) continue;
    out << "0 " << static_cast<std::int64_t>(i + 1) << ' ' << point_type << ' '
        << static_cast<std::int64_t>(nodes.size()) << '\n';
    for (const auto node : nodes) out << ++tag << ' ' << node + 1 << '\n';
  }
  for (const auto& run : runs) {
    out << "3 " << run.block->region[run.begin] + 1 << ' ' << gmsh_type(run.block->type) << ' '
        << static_cast<std::int64_t>(run.end - run.begin) << '\n';
    for (auto cell = run.begin; cell < run.end; ++cell) {
      out << ++tag;
      write_cell_nodes(*run.block, cell, out);
    }
  }
  out << "$EndElements\n";
}

void write_elements22(const Mesh& mesh, OutputFile& out) {
  out << "$Elements\n" << element_count(mesh) << '\n';
  std::int64_t tag = 0;
  for (std::size_t i = 0; i < mesh.node_sets.size(); ++i) {
    const auto number = static_cast<std::int64_t>(i + 1);
    for (const auto node : mesh.node_sets[i].nodes)
      out << ++tag << ' ' << point_type << " 2 " << number << ' ' << number << ' ' << node + 1 << '\n';
  }
  for (const auto& block : mesh.cells)
    for (std::size_t cell = 0; cell < block.region.size(); ++cell) {
      const int number = block.region[cell] + 1;
      out << ++tag << ' ' << gmsh_type(block.type) << " 2 " << number << ' ' << number;
      write_cell_nodes(block, cell, out);
    }
  out << "$EndElements\n";
}

}  // namespace

void write_gmsh41(const Mesh& mesh, OutputFile& out) {
  out << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  write_names(mesh, out);
  write_entities(mesh, out);
  const auto count = mesh.node_count();
  out << "$Nodes\n1 " << count << " 1 " << count << "\n3 1 0 " << count << '\n';
  for (GlobalIndex node = 0; node < count; ++node) out << node + 1 << '\n';
  for (const auto& position : mesh.nodes) {
    write_position(position, out);
    out << '\n';
  }
  out << "$EndNodes\n";
  write_elements41(mesh, out);
}

void write_gmsh22(const Mesh& mesh, OutputFile& out) {
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  write_names(mesh, out);
  out << "$Nodes\n" << mesh.node_count() << '\n';
  GlobalIndex tag = 0;
  for (const auto& position : mesh.nodes) {
    out << ++tag << ' ';
    write_position(position, out);
    out << '\n';
  }
  out << "$EndNodes\n";
  write_elements22(mesh, out);
}

}  // namespace evert
