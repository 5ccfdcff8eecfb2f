#include "evert/scene/body_mesh.hpp"

#include "evert/core/error.hpp"
#include "evert/mesh/mesh_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evert {
namespace {

// --- the mesh before its transform

Mesh make(const FileMesh& file) { return read_mesh(file.path); }

Mesh make(const BoxMesh& box) {
  auto mesh = box.edge_length > 0 ? generate_box(box.size, box.edge_length, box.cell)
                                  : generate_box(box.size, box.cells, box.cell);
  const Vec3d center = 0.5 * (box.min + box.max);
  for (auto& node : mesh.nodes) node += center;
  return mesh;
}

Mesh make(const BallMesh& m) { return generate(ball(m.radius), m.edge_length); }
Mesh make(const TorusMesh& m) { return generate(torus(m.major_radius, m.minor_radius), m.edge_length); }
Mesh make(const CylinderMesh& m) { return generate(cylinder(m.radius, m.length), m.edge_length); }
Mesh make(const CapsuleMesh& m) { return generate(capsule(m.radius, m.length), m.edge_length); }
Mesh make(const EllipsoidMesh& m) { return generate(ellipsoid(m.radii), m.edge_length); }

// --- groups

/// Keeps the cells of the named regions; throws for a name that the mesh does not have.
void keep_groups(Mesh& mesh, const FileMesh& file) {
  for (const auto& group : file.groups)
    if (std::find(mesh.regions.begin(), mesh.regions.end(), group) == mesh.regions.end())
      throw UserError(file.path + ": has no volume group '" + group + "': it has " + list_of(mesh.regions) +
                      did_you_mean(group, mesh.regions));
  const auto kept = [&](std::int32_t region) {
    const auto& name = mesh.regions[static_cast<std::size_t>(region)];
    return std::find(file.groups.begin(), file.groups.end(), name) != file.groups.end();
  };
  for (auto& block : mesh.cells) {
    const auto nodes = static_cast<std::size_t>(node_count(block.type));
    CellBlock rest{.type = block.type, .nodes = {}, .region = {}};
    for (std::size_t c = 0; c < block.region.size(); ++c) {
      if (!kept(block.region[c])) continue;
      const auto first = block.nodes.begin() + static_cast<std::ptrdiff_t>(c * nodes);
      rest.nodes.insert(rest.nodes.end(), first, first + static_cast<std::ptrdiff_t>(nodes));
      rest.region.push_back(block.region[c]);
    }
    block = std::move(rest);
  }
  std::erase_if(mesh.cells, [](const CellBlock& block) { return block.region.empty(); });
}

/// A node without cells has no mass. The others keep their order.
void drop_unused_nodes(Mesh& mesh) {
  constexpr GlobalIndex unused = -1;
  std::vector<GlobalIndex> number(mesh.nodes.size(), unused);
  for (const auto& block : mesh.cells)
    for (const auto node : block.nodes) number[static_cast<std::size_t>(node)] = 0;
  GlobalIndex count = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == unused) continue;
    mesh.nodes[static_cast<std::size_t>(count)] = mesh.nodes[i];
    number[i] = count++;
  }
  if (count == mesh.node_count()) return;
  mesh.nodes.resize(static_cast<std::size_t>(count));
  const auto renumber = [&](GlobalIndex& node) { node = number[static_cast<std::size_t>(node)]; };
  for (auto& block : mesh.cells) std::for_each(block.nodes.begin(), block.nodes.end(), renumber);
  for (auto& set : mesh.node_sets) {
    std::for_each(set.nodes.begin(), set.nodes.end(), renumber);
    std::erase(set.nodes, unused);
  }
}

// --- placement

/// Rodrigues' formula.
Vec3d rotated(const Vec3d& x, const Vec3d& axis, double cosine, double sine) {
  return cosine * x + sine * cross(axis, x) + (1 - cosine) * dot(axis, x) * axis;
}

/// Centres the bounding box at the origin and gives its longest side the length `fit`.
void fit_to(std::vector<Vec3d>& nodes, double fit, const std::string& body) {
  const auto box = bounding_box(nodes);
  const Vec3d size = box.max - box.min;
  const double longest = std::max({size[0], size[1], size[2]});
  if (!(longest > 0)) throw UserError("bodies." + body + ".transform.fit: the mesh is a single point");
  for (auto& x : nodes) x = (fit / longest) * (x - box.center());
}

void place(std::vector<Vec3d>& nodes, const TransformConfig& transform, const std::string& body) {
  if (transform.fit) fit_to(nodes, *transform.fit, body);
  const auto rotation = transform.rotate.value_or(RotationConfig{});
  const double angle = rotation.angle * std::numbers::pi / 180;
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  for (auto& x : nodes) {
    x = transform.scale * x;
    if (transform.rotate) x = rotated(x, rotation.axis, cosine, sine);
    x += transform.translate;
    if (!std::isfinite(x[0] + x[1] + x[2]))
      throw UserError("bodies." + body + ".transform: takes the mesh out of the range of numbers");
  }
}

// --- start

/// The next number of a sequence that visits all 64-bit numbers.  splitmix64, Steele, Lea and Flood 2014
std::uint64_t split_mix(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

Vec3d random_point(const BoundingBox& box, std::uint64_t seed, GlobalIndex node) {
  std::uint64_t state = seed;
  state = split_mix(state) ^ static_cast<std::uint64_t>(node);
  Vec3d x{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double unit = static_cast<double>(split_mix(state) >> 11U) * 0x1.0p-53;
    x[i] = box.min[i] + unit * (box.max[i] - box.min[i]);
  }
  return x;
}

}  // namespace

Mesh make_body_mesh(const BodyConfig& body) {
  auto mesh = std::visit([](const auto& source) { return make(source); }, body.mesh);
  if (const auto* file = std::get_if<FileMesh>(&body.mesh); file != nullptr && !file->groups.empty())
    keep_groups(mesh, *file);
  drop_unused_nodes(mesh);
  place(mesh.nodes, body.transform, body.name);
  return mesh;
}

BoundingBox bounding_box(std::span<const Vec3d> points) {
  BoundingBox box{points.front(), points.front()};
  for (const auto& x : points)
    for (std::size_t i = 0; i < 3; ++i) {
      box.min[i] = std::min(box.min[i], x[i]);
      box.max[i] = std::max(box.max[i], x[i]);
    }
  return box;
}

Vec3d start_position(const StartConfig& start, const BoundingBox& box, const Vec3d& rest, GlobalIndex node) {
  const Vec3d center = box.center();
  const Vec3d along = dot(rest - center, start.axis) * start.axis;
  Vec3d target = rest;
  switch (start.kind) {
    case StartKind::none:
      break;
    case StartKind::scramble:
      target = random_point(box, start.seed, node);
      break;
    case StartKind::flatten_plane:
      target = rest - along;
      break;
    case StartKind::flatten_line:
      target = center + along;
      break;
    case StartKind::flatten_point:
      target = center;
      break;
    case StartKind::inside_out:
      target = rest - 2.0 * along;
      break;
  }
  return (1 - start.amplitude) * rest + start.amplitude * target;
}

}  // namespace evert
