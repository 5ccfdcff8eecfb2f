#pragma once
#include "evert/core/aligned.hpp"
#include "evert/elements/reference_element.hpp"
#include "evert/forces/elastic_block.hpp"
#include "evert/forces/kernels/cpu_level.hpp"
#include "evert/forces/kernels/elastic_kernels.hpp"
#include "evert/mesh/partition.hpp"
#include "evert/mesh/quadratic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

/// Small bodies, awkward states and blocks of every kind for the tests of the element forces.
namespace evert::test {

/// x y z per node and the double of slack that the kernels may read.
using NodalValues = AlignedVector<double>;

inline NodalValues nodal_values(std::span<const Vec3d> values) {
  NodalValues flat;
  for (const Vec3d& v : values) flat.insert(flat.end(), v.components.begin(), v.components.end());
  flat.push_back(std::numeric_limits<double>::quiet_NaN());  // whoever uses the slack is found out
  return flat;
}

inline NodalValues zeros(std::size_t nodes) { return NodalValues(3 * nodes + 1, 0.0); }

inline Vec3d at_node(const NodalValues& values, std::size_t node) {
  return {values[3 * node], values[3 * node + 1], values[3 * node + 2]};
}

/// Unit vectors in all directions, for more cells than any body here has.
inline const std::vector<Vec3d>& many_directions() {
  static const auto all = [] {
    std::mt19937_64 random(23);
    std::normal_distribution<double> normal;
    std::vector<Vec3d> directions(std::size_t{1} << 15U);
    for (Vec3d& d : directions) {
      d = {normal(random), normal(random), normal(random)};
      d = (1 / norm(d)) * d;
    }
    return directions;
  }();
  return all;
}

struct Body {
  CellType type = CellType::tet4;
  std::vector<Vec3d> rest;
  std::vector<LocalIndex> nodes;
  std::vector<Vec3d> fibres = many_directions();  ///< of the first so many cells

  [[nodiscard]] std::size_t nodes_per_cell() const { return static_cast<std::size_t>(node_count(type)); }
  [[nodiscard]] LocalIndex cells() const { return static_cast<LocalIndex>(nodes.size() / nodes_per_cell()); }
  [[nodiscard]] ElasticCells elastic_cells(LocalIndex interior = 0) const {
    return {type, nodes, interior, 1000, std::span(fibres).first(static_cast<std::size_t>(cells()))};
  }
  [[nodiscard]] std::span<const LocalIndex> cell(LocalIndex i) const {
    return std::span(nodes).subspan(static_cast<std::size_t>(i) * nodes_per_cell(), nodes_per_cell());
  }
};

inline constexpr std::array all_elements = all_cell_types;

inline LocalIndex points_per_cell(CellType type) { return static_cast<LocalIndex>(quadrature_points(type)); }

/// Straight-edged tet10 from tet4.
inline Body with_middle_nodes(const Body& corners) {
  Mesh mesh{.nodes = corners.rest, .cells = {}, .regions = {"all"}, .node_sets = {}};
  mesh.cells.push_back({CellType::tet4,
                        {corners.nodes.begin(), corners.nodes.end()},
                        std::vector<std::int32_t>(static_cast<std::size_t>(corners.cells()), 0)});
  make_quadratic(mesh);
  Body body{.type = CellType::tet10, .rest = mesh.nodes, .nodes = {}, .fibres = corners.fibres};
  for (const GlobalIndex node : mesh.cells.front().nodes) body.nodes.push_back(static_cast<LocalIndex>(node));
  return body;
}

/// nx × ny × nz cubes of the given edge, each one hexahedron, two wedges or six tetrahedra; corners shaken by
/// `shake` edges.
inline Body box(CellType type, int nx, int ny, int nz, double edge = 0.1, double shake = 0.1) {
  if (type == CellType::tet10) return with_middle_nodes(box(CellType::tet4, nx, ny, nz, edge, shake));
  Body body{.type = type, .rest = {}, .nodes = {}};
  const auto id = [=](int i, int j, int k) { return (k * (ny + 1) + j) * (nx + 1) + i; };
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> shift(-shake, shake);
  for (int k = 0; k <= nz; ++k) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        const Vec3d corner{i + shift(random), j + shift(random), k + shift(random)};
        body.rest.push_back(edge * corner);
      }
    }
  }
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const std::array v{
            id(i, j, k),     id(i + 1, j, k),     id(i + 1, j + 1, k),     id(i, j + 1, k),
            id(i, j, k + 1), id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)};
        if (type == CellType::hex8) {
          body.nodes.insert(body.nodes.end(), v.begin(), v.end());
          continue;
        }
        if (type == CellType::wedge6) {
          body.nodes.insert(body.nodes.end(), {v[0], v[1], v[2], v[4], v[5], v[6]});
          body.nodes.insert(body.nodes.end(), {v[0], v[2], v[3], v[4], v[6], v[7]});
          continue;
        }
        for (const auto& [a, b] :
             {std::pair<std::size_t, std::size_t>{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}) {
          body.nodes.insert(body.nodes.end(), {v[0], v[a], v[b], v[6]});
        }
      }
    }
  }
  return body;
}

struct State {
  std::string name;
  NodalValues x;
  /// Collapsed in two directions or three, U and V are not unique, and with them the force.
  bool unique = true;
};

/// Positions x = map(X) + noise.
inline NodalValues deformed(const Body& body, const std::function<Vec3d(const Vec3d&)>& map, double noise = 0,
                            unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<Vec3d> x;
  for (const Vec3d& rest : body.rest) {
    const Vec3d shaken{normal(random), normal(random), normal(random)};
    x.push_back(map(rest) + noise * shaken);
  }
  return nodal_values(x);
}

/// Rotation by `angle` about (1, 2, 3).
inline Mat3d rotation(double angle) {
  const Vec3d axis = (1 / std::sqrt(14.0)) * Vec3d{1, 2, 3};
  const Mat3d cross_matrix{{{{0, axis[2], -axis[1]}, {-axis[2], 0, axis[0]}, {axis[1], -axis[0], 0}}}};
  return std::cos(angle) * identity<double>() + std::sin(angle) * cross_matrix +
         (1 - std::cos(angle)) * outer(axis, axis);
}

/// Smooth, noisy, scrambled, inside out, flat, and collapsed to a line and a point. `edge` scales the noise.
inline std::vector<State> awkward_states(const Body& body, double edge = 0.1) {
  const auto stretch = [](double a, double b, double c) {
    return [=](const Vec3d& p) { return Vec3d{a * p[0], b * p[1], c * p[2]}; };
  };
  const Mat3d turn = rotation(0.8);
  return {
      {"bent", deformed(body,
                        [](const Vec3d& p) {
                          return Vec3d{1.1 * p[0] + 0.4 * p[1] * p[1], 0.9 * p[1], p[2] + p[0] * p[1]};
                        })},
      {"turned", deformed(
                     body, [&](const Vec3d& p) { return turn * p; }, 0.02 * edge)},
      {"noisy", deformed(body, stretch(1, 1, 1), 0.2 * edge, 2)},
      {"scrambled", deformed(body, stretch(0, 0, 0), 1.5 * edge, 3)},
      {"inside out", deformed(body, stretch(1, 1, -0.9), 0.1 * edge, 4)},
      {"nearly flat", deformed(body, stretch(1, 1e-6, 1), 0)},
      {"flat", deformed(body, stretch(1.2, 1, 0))},
      {"line", deformed(body, stretch(0, 0, 1.5)), false},
      {"point", deformed(body, stretch(0, 0, 0)), false},
  };
}

inline NodalValues random_velocities(std::size_t nodes, unsigned seed = 5) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<Vec3d> v(nodes);
  for (Vec3d& of_node : v) of_node = {normal(random), normal(random), normal(random)};
  return nodal_values(v);
}

inline constexpr Lame soft = Lame::from_young_poisson(1e4, 0.4);

/// Every model with each of its extensions.
inline std::vector<Material> all_materials(const Lame& lame = soft) {
  return {RotatedLinear{.lame = lame},
          NeoHookean{.lame = lame},
          NeoHookean{.lame = lame, .extension = Extension::clamp},
          StVenantKirchhoff{.lame = lame},
          StVenantKirchhoff{.lame = lame, .extension = Extension::clamp},
          MooneyRivlin{.lame = lame},
          MooneyRivlin{.lame = lame, .extension = Extension::clamp},
          Spline{.lame = lame},
          StableNeoHookean{.lame = lame},
          Muscle{.lame = lame, .peak_stress = 2 * lame.mu},
          Tendon{.lame = lame, .peak_stress = 2 * lame.mu}};
}

/// Not among all models: it is not free of stress at rest.
inline Muscle active_muscle(double activation, const Lame& lame = soft) {
  return {.lame = lame, .peak_stress = 2 * lame.mu, .activation = activation};
}

inline std::string name_of(const Material& material) {
  return std::visit(
      [](const auto& model) {
        std::string name(model.name);
        if constexpr (requires { model.extension; })
          name += model.extension == Extension::clamp ? " clamp" : " linear";
        return name;
      },
      material);
}

/// The stress of `clamp` is the gradient of nothing.
inline bool has_a_potential(const Material& material) {
  return name_of(material).find("clamp") == std::string::npos;
}

inline constexpr Damping rotated_damping{DampingModel::rotated, 30, 20};
inline constexpr Damping objective_damping{DampingModel::objective, 30, 20};
inline constexpr Damping blended_damping{DampingModel::blended, 30, 20};
inline constexpr Damping no_damping{};

/// The kernels on scalars: what every level must agree with.
kernels::ElasticKernels scalar_kernels(CellType type, const Material& material, DampingModel damping);

inline std::unique_ptr<ElasticBlock> scalar_block(const Body& body, const Material& material,
                                                  const Damping& damping) {
  return make_elastic_block(body.elastic_cells(), body.rest, material, damping,
                            scalar_kernels(body.type, material, damping.model));
}

/// A block at a CPU level; `interior` of its cells in the interior batches.
inline std::unique_ptr<ElasticBlock> level_block(const kernels::CpuLevel& level, const Body& body,
                                                 const Material& material, const Damping& damping,
                                                 LocalIndex interior = 0) {
  return make_elastic_block(body.elastic_cells(interior), body.rest, material, damping,
                            level.find(body.type, material, damping.model));
}

/// The levels that this CPU runs, narrowest first: each contains those before it.
inline std::span<const kernels::CpuLevel> supported_levels() {
  const auto all = kernels::cpu_levels();
  return all.first(static_cast<std::size_t>(std::ranges::count_if(all, &kernels::CpuLevel::supported)));
}

inline NodalValues forces(ElasticBlock& block, const NodalValues& x) {
  NodalValues f(x.size(), 0.0);
  block.update(x.data(), f.data(), block.interior());
  block.update(x.data(), f.data(), block.boundary());
  return f;
}

inline NodalValues damping_product(const ElasticBlock& block, const NodalValues& v, double factor = 1) {
  NodalValues out(v.size(), 0.0);
  block.add_damping(v.data(), out.data(), factor, block.interior());
  block.add_damping(v.data(), out.data(), factor, block.boundary());
  return out;
}

/// The largest entry, without the slack.
inline double largest(const NodalValues& values) {
  double most = 0;
  for (std::size_t i = 0; i + 1 < values.size(); ++i) most = std::max(most, std::abs(values[i]));
  return most;
}

/// f = −∂E/∂x, every component, by central differences of `energy(x)`.
template <class Energy>
void expect_gradient(const NodalValues& f, const Energy& energy, NodalValues x, const std::string& label) {
  constexpr double h = 1e-6;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double at = x[i];
    x[i] = at + h;
    const double forward = energy(x);
    x[i] = at - h;
    const double backward = energy(x);
    x[i] = at;
    EXPECT_NEAR(-(forward - backward) / (2 * h), f[i], 1e-7 * largest(f)) << label << ", component " << i;
  }
}

/// Inner forces add up to nothing, and turn nothing.
inline void expect_balance(const NodalValues& x, const NodalValues& f, const std::string& label) {
  Vec3d sum{}, torque{};
  double arm = 0;
  const std::size_t nodes = x.size() / 3;
  for (std::size_t node = 0; node < nodes; ++node) {
    sum += at_node(f, node);
    torque += cross(at_node(x, node), at_node(f, node));
    arm = std::max(arm, norm(at_node(x, node)));
  }
  const double rounding = 1e-13 * largest(f) * static_cast<double>(nodes);
  EXPECT_LE(norm(sum), rounding) << label;
  EXPECT_LE(norm(torque), (arm + 1e-3) * rounding) << label;
}

/// Both halves of the symmetric diagonal blocks of `nodes` nodes, one behind the other.
inline NodalValues damping_diagonal(const ElasticBlock& block, std::size_t nodes) {
  const std::size_t half = 3 * nodes + 1;
  NodalValues blocks(2 * half, 0.0);
  block.add_damping_diagonal(blocks.data(), blocks.data() + half, 1);
  return blocks;
}

inline double largest_difference(const NodalValues& a, const NodalValues& b) {
  double most = 0;
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    const double difference = std::abs(a[i] - b[i]);
    most = std::isfinite(difference) ? std::max(most, difference) : std::numeric_limits<double>::infinity();
  }
  return most;
}

}  // namespace evert::test
