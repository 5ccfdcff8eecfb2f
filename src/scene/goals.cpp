#include "goals.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/mesh/mesh_reader.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <type_traits>

namespace evert {
namespace {

std::string count_text(GlobalIndex count, const char* what) { return std::to_string(count) + " " + what; }

/// The nodes of a file that has the cells of `made`.
std::vector<Vec3d> read_nodes(const MeshGoal& goal, const Mesh& made, const std::string& path) {
  Mesh other = read_mesh(goal.path);
  const auto refuse = [&](const std::string& what, const std::string& there, const std::string& here) {
    throw UserError(path + ".file: '" + goal.path + "' is not the body's mesh in another shape: it has " +
                    what + there + ", the body's has " + here);
  };
  if (other.node_count() != made.node_count())
    refuse("", count_text(other.node_count(), "nodes"), std::to_string(made.node_count()));
  if (other.cell_count() != made.cell_count())
    refuse("", count_text(other.cell_count(), "cells"), std::to_string(made.cell_count()));
  for (const auto& block : made.cells) {
    const auto* same = other.block(block.type);
    if (same == nullptr || same->nodes != block.nodes) refuse("", "other cells of these nodes", "its own");
  }
  return std::move(other.nodes);
}

std::vector<Mat3d> read_deformations(const DeformationGoal& goal, const Mesh& made, const std::string& path) {
  std::ifstream file(goal.path);
  if (!file) throw UserError(path + ".deformations: '" + goal.path + "' cannot be read");
  std::vector<double> numbers;
  for (double number = 0; file >> number;) numbers.push_back(number);
  const auto where = path + ".deformations: '" + goal.path + "' ";
  if (!file.eof())
    throw UserError(where + "has something that is no number after " +
                    count_text(static_cast<GlobalIndex>(numbers.size()), "numbers"));
  const auto needed = static_cast<std::size_t>(9 * made.cell_count());
  if (numbers.size() != needed)
    throw UserError(where + "has " + count_text(static_cast<GlobalIndex>(numbers.size()), "numbers") +
                    ", but nine for each cell are " + std::to_string(needed));
  std::vector<Mat3d> deformations;
  for (std::size_t first = 0; first < numbers.size(); first += 9) {
    Mat3d matrix{};
    for (std::size_t i = 0; i < 9; ++i) matrix(i / 3, i % 3) = numbers[first + i];
    deformations.push_back(matrix);
  }
  return deformations;
}

Vec3d mapped(const FlattenGoal& goal, const Vec3d& from_middle) {
  const Vec3d along = dot(goal.axis, from_middle) * goal.axis;
  return goal.factor * along + (1 / std::sqrt(goal.factor)) * (from_middle - along);
}

Vec3d mapped(const TwistGoal& goal, const Vec3d& from_middle) {
  const double height = dot(goal.axis, from_middle);
  const Vec3d across = from_middle - height * goal.axis;
  const double angle = goal.rate * height;
  return height * goal.axis + std::cos(angle) * across + std::sin(angle) * cross(goal.axis, across);
}

/// Lines along the axis become arcs about one centre, lines across it radii.
Vec3d mapped(const BendGoal& goal, const Vec3d& from_middle) {
  const double s = dot(goal.axis, from_middle), t = dot(goal.towards, from_middle);
  const Vec3d rest = from_middle - s * goal.axis - t * goal.towards;
  if (goal.curvature == 0) return from_middle;
  const double radius = 1 / goal.curvature, angle = goal.curvature * s;
  return rest + (radius - t) * std::sin(angle) * goal.axis +
         (radius - (radius - t) * std::cos(angle)) * goal.towards;
}

void broadcast(MPI_Comm comm, std::vector<double>& numbers) {
  std::uint64_t size = numbers.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, comm);
  numbers.resize(size);
  MPI_Bcast(numbers.data(), static_cast<int>(size), MPI_DOUBLE, 0, comm);
}

void broadcast(MPI_Comm comm, std::vector<Vec3d>& vectors) {
  std::vector<double> flat;
  for (const auto& v : vectors) flat.insert(flat.end(), v.components.begin(), v.components.end());
  broadcast(comm, flat);
  vectors.clear();
  for (std::size_t i = 0; i < flat.size(); i += 3) vectors.push_back({flat[i], flat[i + 1], flat[i + 2]});
}

using Position = decltype(FlowGoal::position);

std::size_t local_node(const DistributedMesh& mesh, std::size_t entry, LocalIndex cell, std::size_t node) {
  const auto& cells = mesh.cells[entry];
  const auto nodes = static_cast<std::size_t>(node_count(cells.type));
  return static_cast<std::size_t>(cells.nodes[nodes * static_cast<std::size_t>(cell) + node]);
}

/// Collective. Where the nodes of another mesh are.
Position positions_of_nodes(const DistributedMesh& mesh, const BodyRange& body, std::vector<Vec3d>& nodes) {
  broadcast(mesh.comm, nodes);
  const auto shared = std::make_shared<const std::vector<Vec3d>>(std::move(nodes));
  return [first = body.first_node, shared](const DistributedMesh& at, std::size_t entry, LocalIndex cell,
                                           std::size_t node) {
    const auto number = at.original_nodes[local_node(at, entry, cell, node)];
    return (*shared)[static_cast<std::size_t>(number - first)];
  };
}

/// Collective. Where the deformations of cells bring their nodes.
Position positions_of_cells(const DistributedMesh& mesh, BodyGoal& goal) {
  std::vector<double> flat;  // number of the cell, nine numbers
  for (std::size_t c = 0; c < goal.deformations.size(); ++c) {
    flat.push_back(static_cast<double>(goal.cells[c]));
    for (const auto& column : goal.deformations[c].column)
      flat.insert(flat.end(), column.components.begin(), column.components.end());
  }
  broadcast(mesh.comm, flat);
  auto by_cell = std::make_shared<std::map<GlobalIndex, Mat3d>>();
  for (std::size_t i = 0; i < flat.size(); i += 10) {
    auto& matrix = (*by_cell)[static_cast<GlobalIndex>(flat[i])];
    for (std::size_t k = 0; k < 9; ++k) matrix(k % 3, k / 3) = flat[i + 1 + k];
  }
  return [by_cell](const DistributedMesh& at, std::size_t entry, LocalIndex cell, std::size_t node) {
    const auto number = at.cells[entry].global_ids[static_cast<std::size_t>(cell)];
    return by_cell->at(number) * at.rest_positions[local_node(at, entry, cell, node)];
  };
}

template <class Map>
Position positions_of_map(const BodyRange& body, const Map& map) {
  return [map, middle = 0.5 * (body.lower + body.upper)](const DistributedMesh& at, std::size_t entry,
                                                         LocalIndex cell, std::size_t node) {
    return mapped(map, at.rest_positions[local_node(at, entry, cell, node)] - middle);
  };
}

}  // namespace

BodyGoal read_goal(const GoalConfig& goal, const Mesh& made, const Mat3d& turned, const std::string& path) {
  BodyGoal result;
  if (const auto* mesh = std::get_if<MeshGoal>(&goal.shape)) {
    result.nodes = read_nodes(*mesh, made, path);
  } else if (const auto* cells = std::get_if<DeformationGoal>(&goal.shape)) {
    for (const auto& deformation : read_deformations(*cells, made, path))
      result.deformations.push_back(times_transpose(turned * deformation, turned));
  }
  return result;
}

std::vector<FlowGoal> flow_goals(const DistributedMesh& mesh, const SceneConfig& scene, SceneMesh& whole) {
  std::vector<FlowGoal> goals;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    if (!body.plasticity || !body.plasticity->goal) continue;
    const auto& config = *body.plasticity->goal;
    BodyGoal none;
    BodyGoal& goal = rank_of(mesh.comm) == 0 ? whole.goals[b] : none;
    const auto position = std::visit(
        [&]<class Shape>(const Shape& shape) -> Position {
          if constexpr (std::is_same_v<Shape, MeshGoal>) {
            return positions_of_nodes(mesh, whole.bodies[b], goal.nodes);
          } else if constexpr (std::is_same_v<Shape, DeformationGoal>) {
            return positions_of_cells(mesh, goal);
          } else {
            return positions_of_map(whole.bodies[b], shape);
          }
        },
        config.shape);
    for (std::size_t r = 0; r < whole.region_body.size(); ++r) {
      const int group = whole.region_group[r];
      const bool own = group >= 0 && body.groups[static_cast<std::size_t>(group)].plasticity.has_value();
      if (whole.region_body[r] == static_cast<int>(b) && !own)
        goals.push_back({static_cast<std::int32_t>(r),
                         "bodies." + body.name + ".plasticity.goal",
                         {config.strength, config.from, config.until},
                         position});
    }
  }
  return goals;
}

}  // namespace evert
