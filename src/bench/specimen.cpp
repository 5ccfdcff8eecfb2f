#include "evert/bench/specimen.hpp"

#include "evert/core/collective.hpp"
#include "evert/math/nodal.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/quadratic.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace evert::bench {
namespace {

constexpr double jitter = 0.15;           // [m], so of an edge: no two tetrahedra alike, none degenerate
constexpr double twist = 0.01;            // [rad/m]
constexpr double stretch = 1.1;           // along the axis of the twist
constexpr double position_noise = 0.305;  // [m] standard deviation; chosen for 8 % inverted tetrahedra

/// Random numbers of a node (or cell) that depend on nothing but its number, so that every partition sees the
/// same body. The mixer is splitmix64 (Steele, Lea, Flood 2014).
class NodeRandom {
 public:
  NodeRandom(GlobalIndex node, std::uint64_t purpose)
      : state_((static_cast<std::uint64_t>(node) << 8U) + purpose) {}

  /// In (0, 1).
  double uniform() {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return (static_cast<double>((z ^ (z >> 31U)) >> 11U) + 0.5) * 0x1p-53;
  }
  /// Standard normal, by Box and Muller.
  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  Vec3d normal3() { return {normal(), normal(), normal()}; }

 private:
  std::uint64_t state_;
};

enum Purpose : std::uint64_t { rest, shake, velocity, fibre };

BoxCells cells_for(CellType type) {
  if (type == CellType::hex8) return BoxCells::hex8;
  return type == CellType::wedge6 ? BoxCells::wedge6 : BoxCells::tet6;
}

/// Collective; only rank 0 needs the mesh.
DistributedMesh jittered_box(MPI_Comm comm, CellType type, int divisions) {
  Mesh mesh;
  on_root(comm, [&] {
    const double side = divisions;
    mesh = generate_box({side, side, side}, {divisions, divisions, divisions}, cells_for(type));
    for (GlobalIndex node = 0; node < mesh.node_count(); ++node) {
      NodeRandom random(node, rest);
      for (double& x : mesh.nodes[static_cast<std::size_t>(node)].components)
        x += jitter * (2 * random.uniform() - 1);
    }
    GlobalIndex cell = 0;
    for (auto& block : mesh.cells) {
      for (GlobalIndex i = 0; i < block.size(); ++i) {
        const Vec3d any = NodeRandom(cell++, fibre).normal3();
        block.vectors.push_back((1 / norm(any)) * any);
      }
    }
    if (type == CellType::tet10) make_quadratic(mesh);
  });
  return distribute(comm, mesh);
}

Vec3d deformed(const Vec3d& x) {
  const double angle = twist * x[2];
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * x[0] - s * x[1], s * x[0] + c * x[1], stretch * x[2]};
}

}  // namespace

Specimen::Specimen(MPI_Comm comm, CellType type, int divisions)
    : mesh(jittered_box(comm, type, divisions)), positions(mesh), velocities(mesh) {
  for (LocalIndex node = 0; node < mesh.local_nodes(); ++node) {
    const auto number = mesh.original_nodes[static_cast<std::size_t>(node)];
    const auto& at_rest = mesh.rest_positions[static_cast<std::size_t>(node)];
    set_node_value(positions.local(), node,
                   deformed(at_rest) + position_noise * NodeRandom(number, shake).normal3());
    set_node_value(velocities.local(), node, NodeRandom(number, velocity).normal3());
  }
  positions.touched();
  velocities.touched();
}

}  // namespace evert::bench
