// Blocks of filtered tetrahedra: what they share with the blocks they replace, and what the filter makes of
// them.
#include "evert/core/aligned.hpp"
#include "evert/filter/filtered_block.hpp"
#include "evert/forces/kernels/cpu_level.hpp"

#include <gtest/gtest.h>

#include "dense_modes.hpp"
#include "plain_filtered.hpp"
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace evert::test {
namespace {

using Values = AlignedVector<double>;  // x y z per node, and the slack that packed kernels read

constexpr Lame lame = Lame::from_young_poisson(1e4, 0.3);
constexpr double density = 1000;
constexpr Damping rotated{DampingModel::rotated, 30, 20}, objective{DampingModel::objective, 30, 20},
    blended{DampingModel::blended, 30, 20};

std::vector<Material> isotropic_models() {
  return {RotatedLinear{.lame = lame}, NeoHookean{.lame = lame}, StVenantKirchhoff{.lame = lame},
          MooneyRivlin{.lame = lame},  Spline{.lame = lame},     StableNeoHookean{.lame = lame}};
}

std::string name_of(const Material& material) {
  return std::visit([](const auto& model) { return std::string(model.name); }, material);
}

/// Tetrahedra of all kinds in a row that share no node.
struct Tets {
  std::vector<Vec3d> rest;
  std::vector<LocalIndex> nodes;

  explicit Tets(int count = 9) {
    std::mt19937_64 random(3);
    for (int c = 0; c < count; ++c)
      for (const Vec3d& corner : random_corners(random, c, 0.05)) {
        nodes.push_back(static_cast<LocalIndex>(rest.size()));
        rest.push_back(0.1 * corner + Vec3d{0.3 * c, 0, 0});
      }
  }
  [[nodiscard]] ElasticCells cells() const { return {CellType::tet4, nodes, 4, density, {}}; }
  [[nodiscard]] std::size_t count() const { return nodes.size() / 4; }
  [[nodiscard]] TetShape shape(std::size_t c) const {
    return tet_shape(std::span(nodes).subspan(4 * c, 4), rest);
  }

  /// One clamp a cell, at this share of its largest eigenvalue against ρV/4.
  [[nodiscard]] std::vector<CellClamp> clamps(double share) const {
    std::vector<CellClamp> all;
    for (std::size_t c = 0; c < count(); ++c) {
      TetMasses masses{};
      masses.fill(density * shape(c).volume / 4);
      all.push_back({masses, share * element_modes(shape(c), masses, lame).largest()});
    }
    return all;
  }

  [[nodiscard]] Values moved(const std::function<Vec3d(const Vec3d&)>& map, double noise = 0) const {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal(0, 1);
    Values x;
    for (const Vec3d& place : rest) {
      const Vec3d to = map(place) + noise * Vec3d{normal(random), normal(random), normal(random)};
      x.insert(x.end(), to.components.begin(), to.components.end());
    }
    x.push_back(std::numeric_limits<double>::quiet_NaN());
    return x;
  }
};

struct State {
  std::string name;
  Values x;
};

std::vector<State> states(const Tets& tets) {
  const auto stretched = [&](double a, double b, double c, double noise) {
    return tets.moved([=](const Vec3d& p) { return Vec3d{a * p[0], b * p[1], c * p[2]}; }, noise);
  };
  return {{"rest", stretched(1, 1, 1, 0)},        {"noisy", stretched(1, 1.1, 0.9, 0.005)},
          {"scrambled", stretched(0, 0, 0, 0.1)}, {"inside out", stretched(1, 1, -1, 0.002)},
          {"flat", stretched(1, 1, 0, 0)},        {"line", stretched(1, 0, 0, 0)},
          {"point", stretched(0, 0, 0, 0)}};
}

Values random_values(const Tets& tets) {
  return tets.moved([](const Vec3d&) { return Vec3d{}; }, 1);
}

std::unique_ptr<ElasticBlock> filtered(const Tets& tets, const Material& material, const Damping& damping,
                                       double share) {
  return make_filtered_block(tets.cells(), tets.rest, material, damping, tets.clamps(share));
}

Values forces(ElasticBlock& block, const Values& x) {
  Values f(x.size(), 0.0);
  block.update(x.data(), f.data(), block.interior());
  block.update(x.data(), f.data(), block.boundary());
  return f;
}

Values damping_forces(const ElasticBlock& block, const Values& v) {
  Values f(v.size(), 0.0);
  block.add_damping(v.data(), f.data(), 1, block.interior());
  block.add_damping(v.data(), f.data(), 1, block.boundary());
  return f;
}

double largest(const Values& values) {
  double most = 0;
  for (std::size_t i = 0; i + 1 < values.size(); ++i)
    most = std::isfinite(values[i]) ? std::max(most, std::abs(values[i]))
                                    : std::numeric_limits<double>::infinity();
  return most;
}

double largest_difference(const Values& a, const Values& b) {
  Values difference = a;
  for (std::size_t i = 0; i + 1 < a.size(); ++i) difference[i] -= b[i];
  return largest(difference);
}

/// Where nothing is above the limit a filtered block is the block that it replaces, in any state with unique
/// rotations.
TEST(FilteredBlock, WithNothingToFilterIsAnOrdinaryBlock) {
  const Tets tets;
  for (const auto& material : isotropic_models())
    for (const auto& damping : {Damping{}, rotated, objective, blended})
      for (const auto& [name, x] : states(tets)) {
        if (name == "line" || name == "point") continue;
        const auto block = filtered(tets, material, damping, 1);
        const auto ordinary = make_elastic_block(tets.cells(), tets.rest, material, damping);
        const std::string label = name_of(material) + ", " + name;
        const auto expected = forces(*ordinary, x);
        EXPECT_LE(largest_difference(forces(*block, x), expected), 1e-9 * (largest(expected) + 1)) << label;
        EXPECT_NEAR(block->energy(x.data()), ordinary->energy(x.data()),
                    1e-9 * (std::abs(ordinary->energy(x.data())) + 1))
            << label;
        EXPECT_EQ(block->inverted_points(x.data()), ordinary->inverted_points(x.data())) << label;
        const auto v = random_values(tets);
        const auto drag = damping_forces(*ordinary, v);
        EXPECT_LE(largest_difference(damping_forces(*block, v), drag), 1e-9 * (largest(drag) + 1)) << label;
        EXPECT_NEAR(block->max_strain_rate(x.data(), v.data()), ordinary->max_strain_rate(x.data(), v.data()),
                    1e-6 * ordinary->max_strain_rate(x.data(), v.data()))
            << label;
        std::vector<double> stretch(tets.count()), same(tets.count());
        block->min_stretch(x.data(), stretch);
        ordinary->min_stretch(x.data(), same);
        for (std::size_t c = 0; c < tets.count(); ++c) EXPECT_NEAR(stretch[c], same[c], 1e-12) << label;
      }
}

Forces of_cell(const Values& values, std::size_t c) {
  Forces four;
  for (std::size_t a = 0; a < 4; ++a)
    four[a] = {values[12 * c + 3 * a], values[12 * c + 3 * a + 1], values[12 * c + 3 * a + 2]};
  return four;
}

/// What the formulas give of a cell, and how much rounding may be magnified: R turns by ε σ1/(σ2 + σ3).
struct Expected {
  Forces forces;
  double condition;
};

/// The largest difference of any cell, over the largest force of that cell and its condition.
double worst_cell(const Values& found, const std::vector<Expected>& expected) {
  double worst = 0;
  for (std::size_t c = 0; c < expected.size(); ++c) {
    const auto [forces, condition] = expected[c];
    const auto cell = of_cell(found, c);
    double difference = 0, size = 1;  // [N]: V E |g| is some 10 N where nothing is strained
    for (std::size_t a = 0; a < 4; ++a) {
      difference = std::max(difference, norm(cell[a] - forces[a]));
      size = std::max(size, norm(forces[a]));
    }
    worst = std::isfinite(difference) ? std::max(worst, difference / size / condition)
                                      : std::numeric_limits<double>::infinity();
  }
  return worst;
}

/// Of one model, damping and state: the packed kernels against the formulas, cell by cell.
void expect_the_formulas(const Tets& tets, const Material& material, const Damping& damping,
                         const State& state) {
  const auto clamps = tets.clamps(0.02);
  const auto block = make_filtered_block(tets.cells(), tets.rest, material, damping, clamps);
  const auto v = random_values(tets);
  std::vector<Expected> elastic, viscous;
  double energy = 0;
  std::visit(
      [&]<class Model>(const Model& model) {
        if constexpr (!HasFibres<Model>)
          for (std::size_t c = 0; c < tets.count(); ++c) {
            const auto shape = tets.shape(c);
            const auto filter =
                strain_filter(element_modes(shape, clamps[c].masses, lame), lame, clamps[c].limit);
            const auto plain = plain_filtered(model, shape, filter, of_cell(state.x, c));
            const auto& sigma = plain.deformation.sigma;
            const double condition = 1 + sigma[0] / (sigma[1] + sigma[2]);
            elastic.push_back({plain.forces, condition});
            viscous.push_back({plain_damping(damping, shape, filter, plain, of_cell(v, c)), condition});
            energy += plain.energy;
          }
      },
      material);
  const std::string label = name_of(material) + ", " + state.name;
  // Rounding, times what flat cells and the small moments of inertia of needles magnify it by.
  EXPECT_LE(worst_cell(forces(*block, state.x), elastic), 1e-11) << label;
  EXPECT_NEAR(block->energy(state.x.data()), energy, 1e-12 * (std::abs(energy) + 1)) << label;
  EXPECT_LE(worst_cell(damping_forces(*block, v), viscous), 1e-11) << label;
}

/// On every instruction set of this machine, whole batches and padded ones.
TEST(FilteredBlock, HasTheForcesOfTheFormulas) {
  const Tets tets(21);
  for (const auto& level : kernels::cpu_levels()) {
    if (!level.supported) continue;
    setenv("EVERT_CPU_LEVEL", std::string(level.name).c_str(), 1);
    for (const auto& material : isotropic_models())
      for (const auto& damping : {rotated, objective, blended})
        for (const auto& state : states(tets)) {
          if (state.name == "line" || state.name == "point") continue;  // R is one of many
          expect_the_formulas(tets, material, damping, state);
        }
  }
  unsetenv("EVERT_CPU_LEVEL");
}

/// By differences of the forces, and as stiffness_matrices() says.
TEST(FilteredBlock, HasTheTangentOfTheFilterAtRest) {
  const Tets tets;
  const auto clamps = tets.clamps(0.02);
  for (const auto& material : isotropic_models()) {
    const auto block = make_filtered_block(tets.cells(), tets.rest, material, {}, clamps);
    auto x = states(tets)[0].x;
    block->stiffness_matrices(
        x.data(), TangentForm::full, [&](LocalIndex cell, std::span<const double> matrix) {
          const auto c = static_cast<std::size_t>(cell);
          const Matrix12 expected =
              dense_filtered(dense_stiffness(tets.shape(c), lame), clamps[c].masses, clamps[c].limit);
          const double step = 1e-7 * 0.005;  // the flattest is 0.005 high
          for (int column = 0; column < 12; ++column) {
            const auto at = static_cast<std::size_t>(12 * cell + column);
            const double kept = x[at];
            x[at] = kept + step;
            const auto forward = forces(*block, x);
            x[at] = kept - step;
            const auto backward = forces(*block, x);
            x[at] = kept;
            for (int row = 0; row < 12; ++row) {
              const auto of_row = static_cast<std::size_t>(12 * cell + row);
              EXPECT_NEAR((backward[of_row] - forward[of_row]) / (2 * step), expected(row, column),
                          1e-5 * expected.norm())
                  << name_of(material);
              EXPECT_NEAR(matrix[static_cast<std::size_t>(12 * row + column)], expected(row, column),
                          1e-9 * expected.norm())
                  << name_of(material);
            }
          }
        });
  }
}

TEST(FilteredBlock, HasFiniteForcesWithoutResultantAndTorque) {
  const Tets tets;
  for (const auto& material : isotropic_models())
    for (const auto& [name, x] : states(tets)) {
      const auto block = filtered(tets, material, {}, 0.02);
      const auto f = forces(*block, x);
      ASSERT_TRUE(std::isfinite(largest(f))) << name_of(material) << ", " << name;
      for (std::size_t c = 0; c < tets.count(); ++c) {
        Vec3d sum{}, torque{};
        double size = 0, arm = 0;
        for (std::size_t a = 0; a < 4; ++a) {
          const auto at = [&](const Values& values) {
            return Vec3d{values[12 * c + 3 * a], values[12 * c + 3 * a + 1], values[12 * c + 3 * a + 2]};
          };
          sum += at(f);
          torque += cross(at(x), at(f));
          size = std::max(size, norm(at(f)));
          arm = std::max(arm, norm(at(x)));
        }
        EXPECT_LE(norm(sum), 1e-14 * size) << name_of(material) << ", " << name;
        EXPECT_LE(norm(torque), 1e-13 * size * (arm + 0.1)) << name_of(material) << ", " << name;
      }
    }
}

/// Of a rigid motion there is neither force nor energy, however the filter distorts the strains.
TEST(FilteredBlock, FeelsNoRigidMotion) {
  const Tets tets;
  const Vec3d axis = (1 / std::sqrt(14.0)) * Vec3d{1, 2, 3};
  const Mat3d across{{{{0, axis[2], -axis[1]}, {-axis[2], 0, axis[0]}, {axis[1], -axis[0], 0}}}};
  const Mat3d turn = identity<double>() + std::sin(2.0) * across + (1 - std::cos(2.0)) * (across * across);
  const auto x = tets.moved([&](const Vec3d& p) { return turn * p + Vec3d{3, -2, 1}; });
  for (const auto& material : isotropic_models()) {
    const auto block = filtered(tets, material, {}, 0.02);
    // Rounding of coordinates of 5 on heights of 0.005 is a strain of 1e-13; V E |g| is some 10 N.
    EXPECT_LE(largest(forces(*block, x)), 1e-9) << name_of(material);
    EXPECT_NEAR(block->energy(x.data()), 0, 1e-12) << name_of(material);
  }
}

Matrix12 matrix_of(const ElasticBlock& block, LocalIndex cell) {
  std::vector<double> numbers(144);
  block.damping_matrix(cell, numbers);
  return Eigen::Map<const Eigen::Matrix<double, 12, 12, Eigen::RowMajor>>(numbers.data());
}

TEST(FilteredBlock, DampsSymmetricallyAndNeverAgainstItself) {
  const Tets tets;
  const auto v = random_values(tets);
  for (const auto& damping : {rotated, objective, blended})
    for (const auto& [name, x] : states(tets)) {
      const auto block = filtered(tets, NeoHookean{.lame = lame}, damping, 0.02);
      forces(*block, x);
      const auto drag = damping_forces(*block, v);
      Values normal(x.size(), 0.0), shear(x.size(), 0.0);
      block->add_damping_diagonal(normal.data(), shear.data(), 1);
      for (LocalIndex cell = 0; cell < block->cells(); ++cell) {
        const Matrix12 c = matrix_of(*block, cell);
        const double size = c.norm() + 1e-300;
        EXPECT_LE((c - c.transpose()).norm(), 1e-13 * size) << name;
        EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix12>(c).eigenvalues().minCoeff(), -1e-13 * size) << name;
        const auto first = 12 * static_cast<std::size_t>(cell);
        const Eigen::Map<const Eigen::Matrix<double, 12, 1>> velocity(v.data() + first),
            force(drag.data() + first);
        EXPECT_LE((c * velocity - force).norm(), 1e-12 * size * velocity.norm()) << name;
        for (int a = 0; a < 4; ++a) {
          const auto node = first + 3 * static_cast<std::size_t>(a);
          const Eigen::Matrix3d block_of_node = c.block<3, 3>(3 * a, 3 * a);
          for (int k = 0; k < 3; ++k) {
            const auto at = node + static_cast<std::size_t>(k);
            EXPECT_NEAR(normal[at], block_of_node(k, k), 1e-13 * size) << name;
            EXPECT_NEAR(shear[at], block_of_node((k + 1) % 3, (k + 2) % 3), 1e-13 * size) << name;
          }
        }
      }
    }
}

/// Damping proportional to stiffness is that of K', not of K.
TEST(FilteredBlock, IsDampedByTheFilteredStiffness) {
  const Tets tets;
  const double time = 1e-3;
  const auto clamps = tets.clamps(0.02);
  const auto damping = Damping::stiffness_proportional(DampingModel::rotated, time, lame.lambda, lame.mu);
  const auto block = make_filtered_block(tets.cells(), tets.rest, NeoHookean{.lame = lame}, damping, clamps);
  forces(*block, states(tets)[0].x);
  for (std::size_t c = 0; c < tets.count(); ++c) {
    const Matrix12 expected =
        time * dense_filtered(dense_stiffness(tets.shape(c), lame), clamps[c].masses, clamps[c].limit);
    EXPECT_LE((matrix_of(*block, static_cast<LocalIndex>(c)) - expected).norm(), 1e-9 * expected.norm());
  }
}

TEST(FilteredBlock, StatesItsStableStep) {
  const Tets tets;
  const auto clamps = tets.clamps(0.02);
  const auto block = make_filtered_block(tets.cells(), tets.rest, NeoHookean{.lame = lame}, {}, clamps);
  const auto rest = states(tets)[0].x;
  double slowest = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < tets.count(); ++c) {
    EXPECT_NEAR(block->rest_stiffness_of(static_cast<LocalIndex>(c)), clamps[c].limit,
                1e-9 * clamps[c].limit);
    slowest = std::min(slowest, 2 / std::sqrt(clamps[c].limit));
  }
  EXPECT_NEAR(block->stable_step(rest.data()).undamped, slowest, 1e-6 * slowest);
  EXPECT_LT(block->stable_step(states(tets)[1].x.data()).undamped, slowest) << "strained, it is stiffer";
  std::vector<double> doubled;
  for (const auto& clamp : clamps)
    for (const double mass : clamp.masses) doubled.push_back(2 * mass);
  block->set_mass_shares(doubled);
  EXPECT_NEAR(block->stable_step(rest.data()).undamped, std::sqrt(2) * slowest, 1e-6 * slowest);
}

/// An event may take all stiffness away, and give it back.
TEST(FilteredBlock, FollowsTheMaterial) {
  const Tets tets;
  const auto block = filtered(tets, NeoHookean{.lame = lame}, rotated, 0.02);
  const auto x = states(tets)[1].x;
  const auto before = forces(*block, x);
  block->set_material(NeoHookean{.lame = {}}, rotated);
  EXPECT_EQ(largest(forces(*block, x)), 0);
  EXPECT_EQ(block->stable_step(x.data()).undamped, std::numeric_limits<double>::infinity());
  block->set_material(NeoHookean{.lame = lame}, rotated);
  EXPECT_LE(largest_difference(forces(*block, x), before), 1e-9 * largest(before));
}

}  // namespace
}  // namespace evert::test
