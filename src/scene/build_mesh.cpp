#include "evert/core/error.hpp"
#include "evert/mesh/quadratic.hpp"
#include "evert/mesh/repair.hpp"
#include "evert/scene/body_mesh.hpp"
#include "evert/scene/build.hpp"

#include "fibres.hpp"
#include "goals.hpp"
#include "solid.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

// Rank 0's part of building a scene: all bodies as one mesh.
namespace evert {
namespace {

struct Bounds {
  Vec3d lower{{1e300, 1e300, 1e300}}, upper{{-1e300, -1e300, -1e300}};
};

Bounds bounds_of(std::span<const Vec3d> points) {
  Bounds b;
  for (const auto& p : points)
    for (std::size_t k = 0; k < 3; ++k) {
      b.lower[k] = std::min(b.lower[k], p[k]);
      b.upper[k] = std::max(b.upper[k], p[k]);
    }
  return b;
}

/// Fit, then scale, then rotate, then translate.
struct Placement {
  Vec3d center{};
  double scale = 1;
  Mat3d turn = identity<double>();
  Vec3d translate{};

  Placement(const Mesh& mesh, const TransformConfig& transform) : translate(transform.translate) {
    const auto bounds = bounds_of(mesh.nodes);
    const auto size = bounds.upper - bounds.lower;
    if (transform.fit) center = 0.5 * (bounds.lower + bounds.upper);
    scale = transform.scale * (transform.fit ? *transform.fit / std::max({size[0], size[1], size[2]}) : 1);
    if (transform.rotate) turn = rotation_of(*transform.rotate);
  }
  void place(std::span<Vec3d> nodes) const {
    for (auto& node : nodes) node = turn * (scale * (node - center)) + translate;
  }
};

void place(Mesh& mesh, const Placement& placement) {
  for (auto& block : mesh.cells)
    for (auto& vector : block.vectors) vector = placement.turn * vector;
  placement.place(mesh.nodes);
}

/// Mean of the cells' corner means, weighted by the volume that the edges at the first corner span: exact for
/// tet4 and for boxes of hex8.
Vec3d center_of_volume(const Mesh& mesh) {
  double volume = 0;
  Vec3d moment{};
  for (const auto& block : mesh.cells) {
    const auto n = static_cast<std::size_t>(node_count(block.type));
    // The corners that share an edge with the first, in VTK's order.
    const auto edges = block.type == CellType::hex8 ? std::array<std::size_t, 3>{1, 3, 4}
                                                    : std::array<std::size_t, 3>{1, 2, 3};
    for (std::size_t cell = 0; cell < block.region.size(); ++cell) {
      const auto corner = [&](std::size_t a) {
        return mesh.nodes[static_cast<std::size_t>(block.nodes[cell * n + a])];
      };
      Vec3d mean{};
      for (std::size_t a = 0; a < n; ++a) mean += (1.0 / static_cast<double>(n)) * corner(a);
      const auto o = corner(0);
      const double share =
          std::abs(dot(corner(edges[0]) - o, cross(corner(edges[1]) - o, corner(edges[2]) - o)));
      volume += share;
      moment += share * mean;
    }
  }
  return volume > 0 ? (1 / volume) * moment : Vec3d{};
}

/// Keeps the cells of the named groups only.
void keep_groups(Mesh& mesh, const std::vector<std::string>& groups, const std::string& body) {
  if (groups.empty()) return;
  std::vector<bool> kept(mesh.regions.size(), false);
  for (const auto& group : groups) {
    const auto found = std::find(mesh.regions.begin(), mesh.regions.end(), group);
    if (found == mesh.regions.end())
      throw UserError("bodies." + body + ".mesh.groups: the mesh has no volume group '" + group +
                      "'; it has " + list_of(mesh.regions) + did_you_mean(group, mesh.regions));
    kept[static_cast<std::size_t>(found - mesh.regions.begin())] = true;
  }
  for (auto& block : mesh.cells) {
    const auto n = static_cast<std::size_t>(node_count(block.type));
    CellBlock filtered{block.type, {}, {}};
    for (std::size_t cell = 0; cell < block.region.size(); ++cell) {
      if (!kept[static_cast<std::size_t>(block.region[cell])]) continue;
      filtered.region.push_back(block.region[cell]);
      if (!block.vectors.empty()) filtered.vectors.push_back(block.vectors[cell]);
      filtered.nodes.insert(filtered.nodes.end(), &block.nodes[cell * n], &block.nodes[cell * n] + n);
    }
    block = std::move(filtered);
  }
  std::erase_if(mesh.cells, [](const CellBlock& block) { return block.region.empty(); });
}

/// The cell field that the mesh file must hold; "" for none.
std::string fibre_field(const BodyConfig& body) {
  const auto* field = body.fibres ? std::get_if<FieldFibres>(&*body.fibres) : nullptr;
  return field == nullptr ? "" : field->field;
}

/// What is read from a file names the file when it is wrong; what is generated does not say where it stands.
Mesh source_mesh(const BodyConfig& body) {
  if (std::holds_alternative<FileMesh>(body.mesh)) return make_body_mesh(body.mesh, fibre_field(body));
  try {
    return make_body_mesh(body.mesh);
  } catch (const UserError& error) {
    throw UserError("bodies." + body.name + ".mesh: " + error.what());
  }
}

/// Of a body whose mesh is not yet placed.
BodyGoal placed_goal(const BodyConfig& body, const Mesh& mesh, const Placement& placement) {
  auto goal =
      read_goal(*body.plasticity->goal, mesh, placement.turn, "bodies." + body.name + ".plasticity.goal");
  placement.place(goal.nodes);
  if (body.order == 2 && !goal.nodes.empty()) {
    Mesh shape = mesh;
    shape.nodes = goal.nodes;
    make_quadratic(shape);
    goal.nodes = std::move(shape.nodes);
  }
  return goal;
}

/// The mesh of a body, and what its flow is led to.
Mesh body_mesh(const BodyConfig& body, BodyGoal& goal) {
  Mesh mesh = source_mesh(body);
  if (const auto* file = std::get_if<FileMesh>(&body.mesh)) keep_groups(mesh, file->groups, body.name);
  drop_unused_nodes(mesh);
  if (mesh.cell_count() == 0) throw UserError("bodies." + body.name + ".mesh: no volume cell is left");
  const Placement placement(mesh, body.transform);
  if (body.plasticity && body.plasticity->goal) goal = placed_goal(body, mesh, placement);
  place(mesh, placement);
  const auto* file = std::get_if<FileMesh>(&body.mesh);
  require_positive_volumes(mesh, file != nullptr ? file->path : "bodies." + body.name + ".mesh");
  try {
    if (body.order == 2) make_quadratic(mesh);
  } catch (const UserError& error) {
    throw UserError("bodies." + body.name + ".order: " + error.what());
  }
  return mesh;
}

/// Per region of the body's own mesh: index of the group that overrides its properties, or −1.
std::vector<int> groups_of_regions(const BodyConfig& body, const Mesh& mesh) {
  std::vector<int> groups(mesh.regions.size(), -1);
  for (std::size_t g = 0; g < body.groups.size(); ++g) {
    const auto& name = body.groups[g].name;
    const auto found = std::find(mesh.regions.begin(), mesh.regions.end(), name);
    if (found == mesh.regions.end())
      throw UserError("bodies." + body.name + ".groups: the mesh has no volume group '" + name +
                      "'; it has " + list_of(mesh.regions) + did_you_mean(name, mesh.regions));
    groups[static_cast<std::size_t>(found - mesh.regions.begin())] = static_cast<int>(g);
  }
  return groups;
}

/// Gives the cells of materials with fibres their directions.
void set_fibre_directions(Mesh& mesh, const BodyConfig& body) {
  if (!body.fibres) return;
  std::vector<bool> with_fibres;
  for (const int group : groups_of_regions(body, mesh))
    with_fibres.push_back(has_fibres(properties_of(body, group).material));
  set_fibre_directions(mesh, body, with_fibres);
}

/// Cells of a body among those of their type.
struct BlockPart {
  CellType type;
  GlobalIndex first, count;
};

/// Their numbers in the mesh, where all blocks are there.
std::vector<GlobalIndex> cell_numbers(const Mesh& mesh, std::span<const BlockPart> parts) {
  std::vector<GlobalIndex> numbers;
  for (const auto& part : parts) {
    GlobalIndex first = part.first;
    for (const auto& block : mesh.cells)
      if (block.type < part.type) first += block.size();
    for (GlobalIndex c = 0; c < part.count; ++c) numbers.push_back(first + c);
  }
  return numbers;
}

/// Joins one body to the scene: nodes appended, cells into the block of their type, regions by material.
std::vector<BlockPart> append(SceneMesh& scene, const Mesh& part, int body_index, const BodyConfig& body) {
  const auto groups = groups_of_regions(body, part);
  std::map<int, std::int32_t> region_of_group;
  const auto region = [&](int group) {
    const auto [entry, is_new] =
        region_of_group.try_emplace(group, static_cast<std::int32_t>(scene.region_body.size()));
    if (is_new) {
      scene.region_body.push_back(body_index);
      scene.region_group.push_back(group);
      scene.mesh.regions.push_back(
          group < 0 ? body.name : body.name + "." + body.groups[static_cast<std::size_t>(group)].name);
    }
    return entry->second;
  };
  std::vector<BlockPart> parts;
  const auto first = scene.mesh.node_count();
  scene.mesh.nodes.insert(scene.mesh.nodes.end(), part.nodes.begin(), part.nodes.end());
  for (const auto& block : part.cells) {
    auto& all = scene.mesh.cells;
    auto place_of =
        std::find_if(all.begin(), all.end(), [&](const auto& other) { return other.type >= block.type; });
    if (place_of == all.end() || place_of->type != block.type)
      place_of = all.insert(place_of, {block.type, {}, {}});
    parts.push_back({block.type, place_of->size(), block.size()});
    // Cells of bodies without fibres have the vector 0.
    if (!block.vectors.empty()) place_of->vectors.resize(place_of->region.size(), Vec3d{});
    place_of->vectors.insert(place_of->vectors.end(), block.vectors.begin(), block.vectors.end());
    for (const auto node : block.nodes) place_of->nodes.push_back(first + node);
    for (const auto own : block.region)
      place_of->region.push_back(region(groups[static_cast<std::size_t>(own)]));
    if (!place_of->vectors.empty()) place_of->vectors.resize(place_of->region.size(), Vec3d{});
  }
  return parts;
}

/// The nodes a constraint names, as numbers of the scene's mesh.
NodeSet select_nodes(const ConstraintConfig& constraint, std::size_t number, const Mesh& part,
                     GlobalIndex first, const std::string& body) {
  NodeSet selected{"constraint_" + std::to_string(number), {}};
  const auto take_if = [&](auto&& inside) {
    for (std::size_t i = 0; i < part.nodes.size(); ++i)
      if (inside(part.nodes[i])) selected.nodes.push_back(first + static_cast<GlobalIndex>(i));
  };
  if (const auto* named = std::get_if<NamedSelection>(&constraint.nodes)) {
    std::vector<std::string> names;
    for (const auto& set : part.node_sets) names.push_back(set.name);
    const auto found = std::find(names.begin(), names.end(), named->node_set);
    if (found == names.end())
      throw UserError("constraints[" + std::to_string(number) + "].node_set: the mesh of body '" + body +
                      "' has no node set '" + named->node_set + "'; it has " +
                      (names.empty() ? "none" : list_of(names)) + did_you_mean(named->node_set, names));
    for (const auto node : part.node_sets[static_cast<std::size_t>(found - names.begin())].nodes)
      selected.nodes.push_back(first + node);
  } else if (const auto* box = std::get_if<BoxSelection>(&constraint.nodes)) {
    take_if([&](const Vec3d& p) {
      bool inside = true;
      for (std::size_t k = 0; k < 3; ++k) inside = inside && p[k] >= box->min[k] && p[k] <= box->max[k];
      return inside;
    });
  } else {
    const auto& sphere = std::get<SphereSelection>(constraint.nodes);
    take_if([&](const Vec3d& p) { return norm(p - sphere.center) <= sphere.radius; });
  }
  if (selected.nodes.empty())
    throw UserError("constraints[" + std::to_string(number) + "] selects no node of body '" + body + "'");
  return selected;
}

}  // namespace

SceneMesh build_scene_mesh(const SceneConfig& scene) {
  SceneMesh all;
  std::map<std::size_t, std::vector<BlockPart>> goal_blocks;  // by body
  all.mesh.node_sets.resize(scene.constraints.size());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    all.goals.emplace_back();
    auto part = body_mesh(body, all.goals.back());
    set_fibre_directions(part, body);
    const auto first = all.mesh.node_count();
    const auto blocks = append(all, part, static_cast<int>(b), body);
    if (!all.goals.back().deformations.empty()) goal_blocks[b] = blocks;
    const auto bounds = bounds_of(part.nodes);
    all.bodies.push_back(
        {body.name, first, all.mesh.node_count(), bounds.lower, bounds.upper, center_of_volume(part)});
    for (std::size_t c = 0; c < scene.constraints.size(); ++c)
      if (scene.constraints[c].body == b)
        all.mesh.node_sets[c] = select_nodes(scene.constraints[c], c, part, first, body.name);
  }
  for (const auto& [b, blocks] : goal_blocks) all.goals[b].cells = cell_numbers(all.mesh, blocks);
  return all;
}

}  // namespace evert
