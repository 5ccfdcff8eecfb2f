// Where motions stop being stable, by bisection between runs: the constant c of each scheme, and the limits
// of meshes with bad elements.  PHYSICS 5 and 9
#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/filter/collatz_wielandt.hpp"
#include "evert/filter/spectrum.hpp"

#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include "tests/support/shared_meshes.hpp"
#include "tests/support/verify.hpp"
#include <algorithm>
#include <cmath>
#include <random>

namespace evert {
namespace {

/// Runs of one scene from a small random displacement of every node, with steps of any length.
class Runs {
 public:
  explicit Runs(const std::string& yaml, const std::vector<std::string>& overrides)
      : scene_(test::build(yaml, overrides)), scalars_(simulation().state_scalars()) {
    const auto& mesh = simulation().mesh();
    NodeField x(mesh);
    std::ranges::copy(simulation().positions().owned(), x.owned().begin());
    MassScaledStiffness stiffness(mesh, simulation().elastic());
    stiffness.assemble(x);
    frequency_ = std::sqrt(fastest_mode(stiffness).squared_frequency);
    rest_.assign(x.owned().begin(), x.owned().end());
    start_ = rest_;
    zero_.assign(rest_.size(), 0.0);
    for (std::size_t i = 0; i < start_.size(); i += 3) {
      std::mt19937_64 random(static_cast<std::uint64_t>(mesh.original_nodes[i / 3]));
      std::uniform_real_distribution<double> shift(-amplitude, amplitude);
      for (std::size_t k = 0; k < 3; ++k) start_[i + k] += shift(random);
    }
  }

  /// Of the fastest vibration [rad/s].
  [[nodiscard]] double frequency() const { return frequency_; }

  /// Whether the displacements stay small; those of an unstable vibration grow until they are not, and then
  /// are still below 1e-3 m.
  [[nodiscard]] bool are_stable(double dt, int steps) {
    simulation().restore({start_, zero_, zero_}, scalars_);
    try {
      for (int step = 0; step < steps; ++step) {
        simulation().step(dt);
        if (step % 10 == 9 && largest_displacement() > 100 * amplitude) return false;
      }
    } catch (const SimulationError&) {  // it noticed first
      return false;
    }
    return true;
  }

  /// The largest stable step between 0.8 and 1.25 times `expected`, to 0.1 %.
  [[nodiscard]] double limit(double expected, int steps) {
    double below = 0.8 * expected, above = 1.25 * expected;
    EXPECT_TRUE(are_stable(below, steps));
    EXPECT_FALSE(are_stable(above, steps));
    while (above - below > 1e-3 * expected) {
      const double middle = 0.5 * (below + above);
      (are_stable(middle, steps) ? below : above) = middle;
    }
    return 0.5 * (below + above);
  }

 private:
  static constexpr double amplitude = 1e-6;  // [m]

  Simulation& simulation() { return *scene_.simulation; }

  double largest_displacement() {
    double largest = 0;
    const auto x = simulation().positions().owned();
    for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - rest_[i]));
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, simulation().mesh().comm);
    return largest;
  }

  BuiltScene scene_;
  std::vector<StateScalar> scalars_;
  std::vector<double> rest_, start_, zero_;
  double frequency_ = 0;
};

struct Scheme {
  const char* method;
  double ratio;  // ξ of the fastest vibration
  double c;
  int steps = 400;
};

double of_newmark(double ratio) { return 2 * (std::sqrt(ratio * ratio + 1) + ratio); }
double of_symplectic_euler(double ratio) { return 2 * (std::sqrt(ratio * ratio + 1) - ratio); }
double of_verlet(double ratio) {
  if (ratio > 0.5) return 1 / ratio;
  return 2 * (std::sqrt(1 - 3 * ratio * ratio) - ratio) / (1 - 4 * ratio * ratio);
}

class StatedConstant : public testing::TestWithParam<Scheme> {};

TEST_P(StatedConstant, IsWhereRunsStopBeingStable) {
  const auto [method, ratio, c, steps] = GetParam();
  const std::string block = R"(
name: block
end_time: 1
bodies:
  block:
    mesh: {generate: box, size: [1, 0.5, 0.5], cells: [3, 2, 2], cell: tet6}
    density: 1000
    material: {model: rotated_linear, youngs_modulus: 1.0e5, poissons_ratio: 0.3}
)";
  std::vector<std::string> overrides{std::string("integrator.method=") + method, "integrator.time_step=1e-3"};
  const double frequency = Runs(block, overrides).frequency();
  if (ratio > 0) {
    overrides.push_back(formatted("bodies.block.damping={model: rotated, stiffness_proportional: %.17g}",
                                  2 * ratio / frequency));
    if (std::string(method) == "newmark") overrides.emplace_back("petsc.damping_ksp_rtol=1e-12");
  }
  Runs runs(block, overrides);
  const double found = runs.limit(c / frequency, steps) * frequency;
  EXPECT_NEAR(found, c, 0.01 * c);
  test::verify(std::string(method) + formatted(", damping ratio %g: stable up to ωΔt", ratio),
               formatted("%.4g", c), found, "1 %");
}

// Explicit Euler: all vibrations become unstable at Δt = τ together up to ξ = 1, where c = 2 ξ, and slowly.
INSTANTIATE_TEST_SUITE_P(All, StatedConstant,
                         testing::Values(Scheme{"newmark", 0, 2}, Scheme{"newmark", 0.5, of_newmark(0.5)},
                                         Scheme{"verlet", 0, 2}, Scheme{"verlet", 0.25, of_verlet(0.25)},
                                         Scheme{"verlet", 0.45, of_verlet(0.45)},
                                         Scheme{"verlet", 1, of_verlet(1), 2000},
                                         Scheme{"symplectic_euler", 0, 2},
                                         Scheme{"symplectic_euler", 0.25, of_symplectic_euler(0.25)},
                                         Scheme{"symplectic_euler", 1, of_symplectic_euler(1)},
                                         Scheme{"explicit_euler", 0.4, 0.8, 4000},
                                         Scheme{"explicit_euler", 1.25, 2 * (1.25 - 0.75), 2000}));

TEST(StatedConstant, OfVerletIsNeverLessThanWhatAutoTakes) {
  for (double ratio = 0; ratio < 5; ratio += 1e-3)
    EXPECT_GE(of_verlet(ratio), of_symplectic_euler(ratio) * (1 - 1e-12)) << ratio;
}

struct Reference {
  const char* mesh;
  double density;  // [kg/m^3]
  double limit;    // [s]
};

class BadMesh : public testing::TestWithParam<Reference> {};

TEST_P(BadMesh, IsStableUpToItsTrueLimit) {
  const auto [name, density, limit] = GetParam();
  const auto path = test::shared_mesh(name);
  if (!path) GTEST_SKIP() << name << " is not there: set EVERT_SHARED_MESHES to its folder";
  const std::string yaml = R"(
name: bad mesh
end_time: 1
bodies:
  body:
    mesh: {file: )" + *path +
                           R"(}
    density: )" + formatted("%g", density) +
                           R"(
    material: {model: rotated_linear, youngs_modulus: 1.0e4, poissons_ratio: 0.3}
)";
  for (const char* method : {"verlet", "symplectic_euler"}) {
    Runs runs(yaml, {std::string("integrator.method=") + method, "integrator.time_step=1e-3"});
    const double theory = 2 / runs.frequency();
    EXPECT_NEAR(theory, limit, 5e-3 * limit);
    const double found = runs.limit(theory, 200);
    EXPECT_NEAR(found, theory, 0.01 * theory);
    test::verify(std::string(name) + ", " + method + ": stable in runs up to [ms]",
                 formatted("%.4f", 1e3 * theory), 1e3 * found, "1 %");
  }
}

INSTANTIATE_TEST_SUITE_P(All, BadMesh,
                         testing::Values(Reference{"wedge_stack.msh", 0.05, 0.1355e-3},
                                         Reference{"cut_cube.msh", 0.06, 0.4598e-3},
                                         Reference{"ball404.msh", 1000, 3.791e-3},
                                         Reference{"ball20k.msh", 1000, 0.5117e-3}));

}  // namespace
}  // namespace evert
