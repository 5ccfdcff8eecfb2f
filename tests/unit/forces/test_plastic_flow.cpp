#include "evert/forces/plastic_cells.hpp"
#include "evert/math/svd3.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"
#include <limits>

/// Flow of one cell and of many, against the closed forms of log strains.  PHYSICS 6
namespace evert::test {
namespace {

const std::vector<Material> isotropic{
    RotatedLinear{.lame = soft}, NeoHookean{.lame = soft}, StVenantKirchhoff{.lame = soft},
    MooneyRivlin{.lame = soft},  Spline{.lame = soft},     StableNeoHookean{.lame = soft}};

ElasticCells plastic_cells(const Body& body, const Plasticity& law) {
  auto cells = body.elastic_cells();
  cells.plasticity = law;
  return cells;
}

std::unique_ptr<ElasticBlock> plastic_block(const Body& body, const Material& material, const Plasticity& law,
                                            const Damping& damping = no_damping) {
  auto block = make_elastic_block(plastic_cells(body, law), body.rest, material, damping);
  block->plastic()->set_times(0, 1);
  return block;
}

/// A unit cube that is deformed as a whole: F is the same at all of its points.
class Cube {
 public:
  explicit Cube(const Plasticity& law, CellType type = CellType::hex8,
                const Material& material = isotropic[1])
      : body_(box(type, 1, 1, 1, 1, 0)), block_(plastic_block(body_, material, law)) {}

  /// The forces at F, after flow; `dt` is the time since the last call.
  NodalValues deform(const Mat3d& f, double dt = 1) {
    x_ = deformed(body_, [&](const Vec3d& p) { return f * p; });
    block_->plastic()->set_times(0, dt);
    return forces(*block_, x_);
  }
  /// F_p = R S without R; of hexahedra, which are not turned.
  [[nodiscard]] Mat3d plastic_stretch() const {
    std::vector<double> l(block_->plastic()->numbers_per_cell());
    block_->plastic()->get(0, l);
    const auto f_p = svd3(matrix(LowerTriangle<double>{l[0], l[1], l[2], l[3], l[4], l[5]}));
    return times_transpose(f_p.v * diagonal(f_p.sigma), f_p.v);
  }
  [[nodiscard]] Mat3d elastic(const Mat3d& f) const { return f * inverse(plastic_stretch()); }
  /// Principal log strains of F_e, ascending, as a vector.
  [[nodiscard]] Vec3d elastic_strain(const Mat3d& f) const {
    const Vec3d sigma = svd3(elastic(f)).sigma;
    return {std::log(sigma[2]), std::log(sigma[1]), std::log(sigma[0])};
  }
  [[nodiscard]] double alpha() const { return number(6); }
  [[nodiscard]] double number(std::size_t i) const {
    std::vector<double> numbers(block_->plastic()->numbers_per_cell());
    block_->plastic()->get(0, numbers);
    return numbers[i];
  }
  [[nodiscard]] Vec3d plastic_stretches() const { return svd3(plastic_stretch()).sigma; }
  [[nodiscard]] double energy() const { return block_->energy(x_.data()); }
  ElasticBlock& block() { return *block_; }

 private:
  Body body_;
  std::unique_ptr<ElasticBlock> block_;
  NodalValues x_;
};

Vec3d deviator(const Vec3d& strain) {
  const double mean = (strain[0] + strain[1] + strain[2]) / 3;
  return strain - Vec3d{mean, mean, mean};
}

double measured(const Plasticity& law, const Vec3d& strain) {
  return norm(law.isochoric ? deviator(strain) : strain);
}

/// Elastoplastic in one dimension: what a path along one direction of log strain must give.
struct OneDimension {
  double yield, hardening;
  double plastic = 0, alpha = 0;

  /// The elastic part of `strain`.
  double follow(double strain) {
    const double trial = strain - plastic;
    const double excess = std::abs(trial) - (yield + hardening * alpha);
    if (excess > 0) {
      const double step = excess / (1 + hardening);
      plastic += std::copysign(step, trial);
      alpha += step;
    }
    return strain - plastic;
  }
};

const Plasticity von_mises{.yield = 0.05, .hardening = 0.3};
const Plasticity total{.yield = 0.05, .hardening = 0.3, .isochoric = false};

Mat3d exponential(const Vec3d& strain) {
  return diagonal(Vec3d{std::exp(strain[0]), std::exp(strain[1]), std::exp(strain[2])});
}

/// Up, down, beyond, back and up again, in small steps and large ones.
std::vector<double> cycle() {
  std::vector<double> path;
  for (int i = 0; i <= 40; ++i) path.push_back(0.01 * i);
  for (int i = 0; i <= 20; ++i) path.push_back(0.4 - 0.035 * i);
  path.insert(path.end(), {0.1, 0.6, 0.58, 0.0});
  return path;
}

/// Follows `direction`, of length 1 as the law measures it, and compares with one dimension.
void expect_closed_form(const Plasticity& law, const Vec3d& direction, const Mat3d& turn,
                        const std::string& label) {
  Cube cube(law);
  OneDimension exact{law.yield, law.hardening};
  for (const double strain : cycle()) {
    const Mat3d f = turn * exponential(strain * direction) * transpose(rotation(0.5));
    cube.deform(f);
    const double elastic = exact.follow(strain);
    EXPECT_NEAR(measured(law, cube.elastic_strain(f)), std::abs(elastic), 1e-12) << label << " at " << strain;
    EXPECT_NEAR(cube.alpha(), exact.alpha, 1e-12) << label << " at " << strain;
    const Vec3d along = exact.plastic * (law.isochoric ? deviator(direction) : direction);
    const Vec3d stretches = cube.plastic_stretches();
    Vec3d expected{std::exp(along[0]), std::exp(along[1]), std::exp(along[2])};
    std::ranges::sort(expected.components, std::greater<>{});
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(stretches[i], expected[i], 1e-12) << label << " at " << strain;
  }
}

TEST(PlasticFlow, FollowsTheClosedFormInTensionShearAndCycles) {
  const Vec3d tension{1, 0, 0};
  const Vec3d shear{std::sqrt(0.5), -std::sqrt(0.5), 0};
  expect_closed_form(total, tension, identity<double>(), "tension, all of the strain");
  expect_closed_form(von_mises, std::sqrt(1.5) * tension, identity<double>(), "tension, deviator");
  expect_closed_form(total, shear, rotation(2), "shear, all of the strain");
  expect_closed_form(von_mises, shear, rotation(2), "shear, deviator");
  expect_closed_form(von_mises, std::sqrt(1.5) * Vec3d{-1, 0, 0}, rotation(-1), "compression, deviator");
}

/// b_e of a simple shear that is made in one step: its axes are those of the trial, its strain is on the
/// surface.
TEST(PlasticFlow, ReturnsASimpleShearAlongItsAxes) {
  const double k = 0.4;
  Mat3d f = identity<double>();
  f(0, 1) = k;
  Cube cube(von_mises);
  cube.deform(f);
  const double trial = std::asinh(k / 2);
  const double length = std::sqrt(2.0) * trial;
  const double step = (length - von_mises.yield) / (1 + von_mises.hardening);
  const double left = trial * (1 - step / length);
  const Mat3d elastic = cube.elastic(f);
  const Mat3d b = times_transpose(elastic, elastic);
  // The larger axis of F Fᵀ = [[1 + k², k], [k, 1]] has twice the angle atan(2/k).
  const double angle = 0.5 * std::atan2(2.0, k);
  const double c = std::cos(angle), s = std::sin(angle);
  const double large = std::exp(2 * left), small = std::exp(-2 * left);
  EXPECT_NEAR(b(0, 0), c * c * large + s * s * small, 1e-12);
  EXPECT_NEAR(b(1, 1), s * s * large + c * c * small, 1e-12);
  EXPECT_NEAR(b(0, 1), c * s * (large - small), 1e-12);
  EXPECT_NEAR(b(2, 2), 1, 1e-12);
}

Mat3d random_gradient(std::mt19937_64& random, double spread) {
  std::normal_distribution<double> normal(0, spread);
  Mat3d f = identity<double>();
  for (auto& column : f.column)
    for (double& entry : column.components) entry += normal(random);
  return f;
}

TEST(PlasticFlow, EndsOnTheYieldSurfaceAndKeepsVolumeOnRandomPaths) {
  std::mt19937_64 random(3);
  for (const auto& law : {von_mises, total, Plasticity{.yield = 0.01, .limit = 2}})
    for (const auto& material : isotropic) {
      Cube cube(law, CellType::hex8, material);
      double outside = 0, volume = 0;
      for (int step = 0; step < 400; ++step) {
        const Mat3d f = random_gradient(random, 0.05);
        const double before = cube.alpha();
        cube.deform(f);
        // Far compressed, its stress decreases: to return would cost energy, and nothing flows.
        if (std::holds_alternative<StVenantKirchhoff>(material) && cube.alpha() == before) continue;
        const Vec3d plastic = cube.plastic_stretches();
        const bool at_limit = std::max(plastic[0], 1 / plastic[2]) > law.limit * (1 - 1e-9);
        if (!at_limit)
          outside = std::max(
              outside, measured(law, cube.elastic_strain(f)) - law.yield - law.hardening * cube.alpha());
        volume = std::max(volume, std::abs(plastic[0] * plastic[1] * plastic[2] - 1));
        EXPECT_LE(plastic[0], law.limit * (1 + 1e-12));
        EXPECT_GE(plastic[2], (1 - 1e-12) / law.limit);
      }
      EXPECT_LE(outside, 1e-12) << name_of(material);
      EXPECT_GT(cube.alpha(), 0.1) << name_of(material);
      if (law.isochoric) {
        EXPECT_LE(volume, 1e-12) << name_of(material);
      }
    }
}

/// Inverted, flat and enormous trial states included: flow takes energy, all of it is work on flow, and F_p
/// stays within its limit.
TEST(PlasticFlow, TakesEnergyOnTenThousandRandomPaths) {
  std::mt19937_64 random(4);
  int flown = 0, inverted = 0;
  for (int path = 0; path < 10000; ++path) {
    const auto& material = isotropic[static_cast<std::size_t>(path) % isotropic.size()];
    const Plasticity law{
        .yield = 0.02, .hardening = path % 3 == 0 ? 0.5 : 0, .isochoric = path % 2 == 0, .limit = 3};
    Cube cube(law, CellType::tet4, material);
    for (int step = 0; step < 4; ++step) {
      const Mat3d f = random_gradient(random, step < 2 ? 0.2 : 0.8);
      inverted += determinant(f) < 0 ? 1 : 0;
      const double before = cube.block().plastic()->work();
      cube.deform(f);
      const double work = cube.block().plastic()->work() - before;
      ASSERT_GE(work, 0) << path;
      flown += work > 0 ? 1 : 0;
      const Vec3d plastic = cube.plastic_stretches();
      ASSERT_LE(plastic[0], law.limit * (1 + 1e-9)) << path;
      ASSERT_GE(plastic[2], (1 - 1e-9) / law.limit) << path;
    }
  }
  EXPECT_GT(flown, 10000);
  EXPECT_GT(inverted, 3000);
}

/// What forces do on a path that flows is kept as energy or spent as work on flow, to first order in the
/// steps.
TEST(PlasticFlow, SpendsWhatForcesDo) {
  const Body body = box(CellType::hex8, 1, 1, 1, 1, 0);
  for (const auto& material : isotropic) {
    double before = 0;
    for (const int steps : {200, 400, 800}) {
      const auto block = plastic_block(body, material, {.yield = 0.05, .hardening = 0.2});
      NodalValues x = nodal_values(body.rest), f = forces(*block, x);
      double done = 0;
      for (int step = 1; step <= steps; ++step) {
        const double s = static_cast<double>(step) / steps;
        const auto next = deformed(body, [&](const Vec3d& p) {
          return Vec3d{p[0] * (1 + 0.5 * s), p[1] + 0.4 * s * s * p[0], p[2] * (1 - 0.3 * s)};
        });
        const auto force = forces(*block, next);
        for (std::size_t i = 0; i + 1 < x.size(); ++i) done -= 0.5 * (force[i] + f[i]) * (next[i] - x[i]);
        x = next;
        f = force;
      }
      EXPECT_GT(block->plastic()->work(), 0.5 * done);
      const double error = std::abs(done - block->energy(x.data()) - block->plastic()->work()) / done;
      EXPECT_LT(error, 2.0 / steps) << name_of(material);
      if (before > 0) {
        EXPECT_LT(error, 0.7 * before) << name_of(material);
      }
      before = error;
    }
  }
}

/// A homogeneous deformation is that of every kind of element.
TEST(PlasticFlow, IsThatOfEveryElement) {
  std::mt19937_64 random(5);
  for (const auto& material : isotropic) {
    std::vector<std::unique_ptr<Cube>> cubes;
    for (const auto type : all_elements) cubes.push_back(std::make_unique<Cube>(von_mises, type, material));
    for (int step = 0; step < 20; ++step) {
      const Mat3d f = random_gradient(random, 0.1);
      for (auto& cube : cubes) cube->deform(f);
      for (auto& cube : cubes) {
        EXPECT_NEAR(cube->energy(), cubes.front()->energy(), 1e-9 * cubes.front()->energy());
        EXPECT_NEAR(cube->block().plastic()->work(), cubes.front()->block().plastic()->work(),
                    1e-9 * cubes.front()->block().plastic()->work());
        EXPECT_NEAR(cube->alpha(), cubes.front()->alpha(), 1e-10);
      }
    }
    EXPECT_GT(cubes.front()->alpha(), 0.1);
  }
}

/// Of all elements, in awkward states: forces with yield at infinity, and with a yield that nothing reaches.
TEST(PlasticFlow, OfNothingIsElasticBitByBit) {
  for (const auto type : all_elements)
    for (const auto& material : isotropic)
      for (const auto& damping : {no_damping, rotated_damping, objective_damping}) {
        const Body body = box(type, 2, 2, 1);
        const auto elastic = make_elastic_block(body.elastic_cells(), body.rest, material, damping);
        for (const double yield : {std::numeric_limits<double>::infinity(), 1e6}) {
          const auto plastic = plastic_block(body, material, {.yield = yield}, damping);
          EXPECT_EQ(elastic->plastic(), nullptr);
          for (const auto& state : awkward_states(body)) {
            const auto f = forces(*elastic, state.x), flown = forces(*plastic, state.x);
            const auto v = random_velocities(body.rest.size());
            EXPECT_EQ(f, flown) << name_of(material) << ", " << state.name;
            EXPECT_EQ(damping_product(*elastic, v), damping_product(*plastic, v)) << state.name;
            EXPECT_EQ(elastic->energy(state.x.data()), plastic->energy(state.x.data()));
            EXPECT_EQ(elastic->stable_step(state.x.data()).damped,
                      plastic->stable_step(state.x.data()).damped);
          }
          EXPECT_EQ(plastic->plastic()->work(), 0);
        }
      }
}

/// Once more at the same place nothing flows, and nothing changes.
TEST(PlasticFlow, RestsWhereItHasReturned) {
  for (const auto type : all_elements) {
    const Body body = box(type, 2, 1, 2);
    const auto block = plastic_block(body, isotropic[1], von_mises, rotated_damping);
    const auto x = deformed(
        body,
        [](const Vec3d& p) {
          return Vec3d{1.4 * p[0], p[1] + 0.3 * p[0], 0.8 * p[2]};
        },
        0.01);
    const auto first = forces(*block, x);
    const double work = block->plastic()->work();
    EXPECT_GT(work, 0);
    EXPECT_EQ(forces(*block, x), first);
    EXPECT_EQ(block->plastic()->work(), work);
  }
}

/// What a cell remembers is the same in another block of other neighbours, bit by bit.
TEST(PlasticFlow, IsRememberedByAnotherBlock) {
  for (const auto type : all_elements) {
    const Body body = box(type, 2, 2, 1);
    const auto x = deformed(
        body,
        [](const Vec3d& p) {
          return Vec3d{1.3 * p[0], p[1] + 0.3 * p[0], p[2]};
        },
        0.01);
    const auto block = plastic_block(body, isotropic[0], von_mises);
    forces(*block, x);
    auto cells = plastic_cells(body, von_mises);
    cells.interior = body.cells() / 2;  // other batches
    const auto other = make_elastic_block(cells, body.rest, isotropic[0], no_damping);
    std::vector<double> numbers(block->plastic()->numbers_per_cell());
    for (LocalIndex c = 0; c < body.cells(); ++c) {
      block->plastic()->get(c, numbers);
      other->plastic()->set(c, numbers);
    }
    const auto there = forces(*block, x), here = forces(*other, x);
    EXPECT_LE(largest_difference(there, here), 1e-13 * largest(there));  // of the order of the sums
    EXPECT_DOUBLE_EQ(block->plastic()->work(), other->plastic()->work());
    const double step = block->stable_step(x.data()).undamped;
    EXPECT_GT(step, 0);
    EXPECT_NEAR(other->stable_step(x.data()).undamped, step, 1e-12 * step);
  }
}

/// With a relaxation time the excess decays as e^(−t/τ) when the steps are small.
TEST(PlasticFlow, RelaxesInTime) {
  const Plasticity law{.yield = 0.02, .relaxation_time = 0.5};
  double before = 0;
  for (const int steps : {50, 100, 200}) {
    Cube cube(law);
    const Mat3d f = exponential({0.1, -0.1, 0});
    const double excess = norm(Vec3d{0.1, -0.1, 0}) - law.yield;
    cube.deform(f, 0);  // no time has passed
    EXPECT_EQ(cube.alpha(), 0);
    for (int i = 0; i < steps; ++i) cube.deform(f, 1.0 / steps);
    const double error = std::abs(excess - cube.alpha() - excess * std::exp(-2.0));
    if (before > 0) {
      EXPECT_NEAR(before / error, 2, 0.1);
    }
    before = error;
  }
  EXPECT_LT(before, 1e-3);
}

/// The forces are the gradient of the energy that is left, as long as nothing flows.
TEST(PlasticFlow, LeavesForcesThatAreTheGradientOfTheEnergy) {
  for (const auto type : all_elements) {
    const Body body = box(type, 1, 1, 1);
    for (const auto& material : isotropic) {
      const auto block = plastic_block(body, material, {.yield = 0.05, .isochoric = false});
      forces(*block, deformed(body, [](const Vec3d& p) {
        return Vec3d{1.3 * p[0], p[1] + 0.2 * p[0], 0.9 * p[2]};
      }));
      // Back half of the way: within the surface.
      const auto x = deformed(body, [](const Vec3d& p) {
        return Vec3d{1.25 * p[0], p[1] + 0.2 * p[0], 0.91 * p[2]};
      });
      const double work = block->plastic()->work();
      const auto f = forces(*block, x);
      ASSERT_EQ(block->plastic()->work(), work);
      expect_gradient(
          f, [&](const NodalValues& y) { return block->energy(y.data()); }, x, name_of(material));
      expect_balance(x, f, name_of(material));
    }
  }
}

/// The stable step of what has flown is that of a body made in this shape.
TEST(PlasticFlow, BoundsTheStepByTheShapeThatIsLeft) {
  const auto map = [](const Vec3d& p) { return Vec3d{1.5 * p[0], p[1] / 1.5, p[2] + 0.2 * p[0]}; };
  for (const auto type : all_elements) {
    const Body body = box(type, 2, 1, 1);
    const auto block = plastic_block(body, isotropic[0], {.yield = 1e-9});
    const auto x = deformed(body, map);
    forces(*block, x);
    Body made = body;
    for (Vec3d& p : made.rest) p = map(p);
    const auto fresh = make_elastic_block(made.elastic_cells(), made.rest, isotropic[0], no_damping);
    const double step = block->stable_step(x.data()).undamped;
    EXPECT_NEAR(step, fresh->stable_step(x.data()).undamped, 1e-3 * step);
    // In many small steps: never above, and by little below.
    const auto slowly = plastic_block(body, isotropic[0], {.yield = 1e-9});
    for (int i = 1; i <= 1000; ++i) {
      const double s = i / 1000.0;
      const auto way = [&](const Vec3d& p) { return (1 - s) * p + s * map(p); };
      const auto at = deformed(body, way);
      forces(*slowly, at);
      for (Vec3d& p : made.rest = body.rest) p = way(p);
      const auto there = make_elastic_block(made.elastic_cells(), made.rest, isotropic[0], no_damping);
      if (i % 100 != 37) {
        slowly->stable_step(at.data());
        continue;
      }
      const double limit = there->stable_step(at.data()).undamped;
      EXPECT_LE(slowly->stable_step(at.data()).undamped, limit * (1 + 1e-3));
      EXPECT_GE(slowly->stable_step(at.data()).undamped, 0.92 * limit);
    }
  }
}

// --- control.  paper A, section 7

/// A cube of which every cell is to become `goal` times what it is.
std::vector<LocalIndex> set_goal(ElasticBlock& block, const Body& body, const PlasticControl& control,
                                 const Mat3d& goal) {
  return block.plastic()->set_goal(control, [&](LocalIndex cell, std::size_t a) {
    return goal * body.rest[static_cast<std::size_t>(body.cell(cell)[a])];
  });
}

double distance_to_goal(ElasticBlock& block) { return std::sqrt(block.plastic()->square_distance_to_goal()); }

const Mat3d disk = rotation(1.1) * diagonal(Vec3d{1.5, 0.5, 1.4}) * rotation(0.3);

TEST(PlasticControl, NeverMovesAwayFromTheGoalInTenThousandRandomSteps) {
  std::mt19937_64 random(8);
  for (const double strength : {0.0, 2.0})
    for (const auto type : all_elements) {
      const Body body = box(type, 1, 1, 1, 1, 0.1);
      const auto block = plastic_block(body, isotropic[1], {.yield = 0.02, .isochoric = false});
      ASSERT_TRUE(set_goal(*block, body, {.strength = strength}, disk).empty());
      double distance = distance_to_goal(*block);
      const double start = distance;
      EXPECT_NEAR(distance, std::sqrt(block->plastic()->square_of_goal()), 1e-12 * distance);
      for (int step = 0; step < 1250; ++step) {
        const Mat3d f = random_gradient(random, 0.3);
        block->plastic()->set_times(step, step + 0.001);
        forces(*block, deformed(
                           body, [&](const Vec3d& p) { return f * p; }, 0.01, static_cast<unsigned>(step)));
        const double next = distance_to_goal(*block);
        ASSERT_LE(next, distance * (1 + 1e-12)) << name_of(type) << ", step " << step;
        distance = next;
        ASSERT_GE(block->plastic()->work(), 0);
      }
      EXPECT_LT(distance, 0.5 * start) << name_of(type);
    }
}

/// By itself log S goes to its goal as e^(−strength t), whatever holds the body.
TEST(PlasticControl, ApproachesTheGoalAtItsRate) {
  for (const auto type : all_elements) {
    const Body body = box(type, 1, 1, 1, 1, 0.1);
    const auto block = plastic_block(body, isotropic[1], {.isochoric = false});
    ASSERT_TRUE(set_goal(*block, body, {.strength = 3, .from = 1, .until = 2}, disk).empty());
    const double start = distance_to_goal(*block);
    const auto x = nodal_values(body.rest);
    for (int step = 0; step < 30; ++step) {
      block->plastic()->set_times(0.1 * step, 0.1 * (step + 1));
      forces(*block, x);
      const double in_force = std::clamp(0.1 * (step + 1) - 1, 0.0, 1.0);
      EXPECT_NEAR(distance_to_goal(*block), start * std::exp(-3 * in_force), 1e-10 * start) << name_of(type);
    }
    EXPECT_GT(block->plastic()->control_work(), 0);  // the body is held in its old shape
    EXPECT_EQ(block->plastic()->work(), 0);
    EXPECT_NEAR(block->plastic()->control_work(), block->energy(x.data()), 1e-9 * block->energy(x.data()));
  }
}

TEST(PlasticControl, RefusesGoalsThatAreInvertedFlatOrBeyondTheLimit) {
  const Body body = box(CellType::tet4, 1, 1, 1, 1, 0.1);
  const auto block = plastic_block(body, isotropic[1], {.isochoric = false, .limit = 3});
  for (const Mat3d& goal : {diagonal(Vec3d{1, 1, -1}), diagonal(Vec3d{1, 1, 0}), diagonal(Vec3d{3.1, 1, 1}),
                            diagonal(Vec3d{1, 0.3, 1})})
    EXPECT_EQ(static_cast<LocalIndex>(set_goal(*block, body, {}, goal).size()), body.cells());
  EXPECT_EQ(block->plastic()->square_of_goal(), 0);
  EXPECT_TRUE(set_goal(*block, body, {}, rotation(2) * diagonal(Vec3d{2.9, 0.4, 1})).empty());
}

}  // namespace
}  // namespace evert::test
