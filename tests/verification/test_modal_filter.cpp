// Bodies with filtered elements in motion: steps far beyond their own limit, momenta, energy, recovery,
// ranks.
#include "evert/core/error.hpp"
#include "evert/filter/collatz_wielandt.hpp"
#include "evert/filter/spectrum.hpp"
#include "evert/math/nodal.hpp"

#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include "tests/support/shared_meshes.hpp"
#include "tests/support/strain.hpp"
#include "tests/support/verify.hpp"
#include <array>
#include <cmath>
#include <memory>
#include <string>

namespace evert {
namespace {

using enum FilterSelection;

/// A mesh of PHYSICS 9 in motion at a step far beyond its own.
struct Motion {
  const char* mesh;
  double density;    ///< [kg/m³]
  double time_step;  ///< [s]
  FilterSelection selection;
  double
      amplitude;  ///< [-] of the strain at the start; the soft elements are strained up to ten times as much
};
constexpr std::array motions{Motion{"wedge_stack", 0.05, 0.7e-3, paper, 0.002},
                             Motion{"wedge_stack", 0.05, 0.7e-3, spare_mass, 0.01},
                             Motion{"wedge_stack", 0.05, 0.7e-3, adaptive, 0.002},
                             Motion{"cut_cube", 0.06, 0.9e-3, spare_mass, 0.03},
                             Motion{"cut_cube", 0.06, 0.9e-3, adaptive, 0.02},
                             Motion{"ball404", 1000, 7.5e-3, paper, 0.0008},
                             Motion{"ball404", 1000, 7.5e-3, spare_mass, 0.004},
                             Motion{"ball404", 1000, 7.5e-3, adaptive, 0.004}};

constexpr Lame reference_lame = Lame::from_young_poisson(1e4, 0.3);

SimulationDefinition moving(const DistributedMesh& mesh, const Motion& motion, const Material& material) {
  SimulationDefinition definition;
  definition.properties.assign(mesh.regions.size(), {motion.density, material, {}});
  definition.fixed_time_step = motion.time_step;
  definition.filter = {.time_step = motion.time_step, .selection = motion.selection};
  const double amplitude = motion.amplitude;
  for (LocalIndex i = 0; i < mesh.owned_nodes; ++i) {
    const Vec3d& p = mesh.rest_positions[static_cast<std::size_t>(i)];
    definition.initial_positions.push_back(p +
                                           amplitude * Vec3d{p[0] + 0.5 * p[1], -0.5 * p[1], -0.4 * p[0]});
    definition.initial_velocities.push_back(10 * amplitude *
                                            (Vec3d{1, 2, 0.5} + cross(Vec3d{0.3, 1, -0.5}, p)));
  }
  return definition;
}

class InMotion : public testing::TestWithParam<Motion> {
 protected:
  void SetUp() override {
    path_ = test::shared_mesh(std::string(GetParam().mesh) + ".msh").value_or("");
    if (path_.empty()) GTEST_SKIP() << GetParam().mesh << ".msh is not in EVERT_SHARED_MESHES";
  }
  [[nodiscard]] std::unique_ptr<Simulation> simulation(const Material& material, bool filtered = true,
                                                       MPI_Comm comm = PETSC_COMM_WORLD) const {
    auto mesh = test::distributed(path_, comm);
    auto definition = moving(mesh, GetParam(), material);
    if (!filtered) definition.filter.reset();
    return std::make_unique<Simulation>(std::move(mesh), std::move(definition));
  }
  void tell(const std::string& what, const std::string& expected, double found,
            const std::string& tolerance) const {
    test::verify("modal filter: " + std::string(GetParam().mesh) + " at " +
                     std::to_string(static_cast<int>(1e6 * GetParam().time_step)) + " us, " +
                     name_of(GetParam().selection) + ": " + what,
                 expected, found, tolerance);
  }
  std::string path_;
};

/// The energy that the scheme keeps of linear forces, ½ vᵀMv + ψ − Δt²/8 fᵀM⁻¹f: ψ by itself swings between
/// kinetic and elastic with every vibration near the limit, where the last term is as large as ψ. Without the
/// flight of the whole body, which may be most of it. On one rank.
class KeptEnergy {
 public:
  KeptEnergy(const Simulation& simulation, const SimulationDefinition& definition)
      : simulation_(simulation),
        forces_(simulation.mesh(), definition.properties),
        filter_(simulation.mesh(), forces_, *definition.filter),
        x_(simulation.mesh()),
        f_(simulation.mesh()),
        dt_(definition.fixed_time_step) {}

  [[nodiscard]] double now() {
    const auto owned = simulation_.positions().owned();
    std::copy(owned.begin(), owned.end(), x_.owned().begin());
    x_.touched();
    forces_.update(x_, f_);
    double swing = 0, mass = 0;
    for (const double m : forces_.masses()) mass += m;
    for (std::size_t i = 0; i < owned.size(); ++i)
      swing += f_.owned()[i] * f_.owned()[i] / forces_.masses()[i / 3];
    const auto all = simulation_.measure();
    const double flight = dot(all.momentum, all.momentum) / (2 * mass);
    return all.kinetic_energy - flight + all.elastic_energy - dt_ * dt_ / 8 * swing;
  }

 private:
  const Simulation& simulation_;
  ElasticForces forces_;
  ModalFilter filter_;
  NodeField x_, f_;
  double dt_;
};

struct History {
  double energy = 0, momentum = 0, angular_momentum = 0, strain = 0;
};

History history_of(Simulation& simulation, KeptEnergy& energy, double dt) {
  History history;
  const auto before = simulation.measure();
  const double at_first = energy.now();
  for (int step = 1; step <= 2000; ++step) {
    simulation.step(dt);
    if (step <= 1500) history.energy = std::max(history.energy, std::abs(energy.now() / at_first - 1));
    if (step % 20 == 0) history.strain = std::max(history.strain, test::largest_strain(simulation));
  }
  const auto after = simulation.measure();
  history.momentum = norm(after.momentum - before.momentum) / norm(before.momentum);
  history.angular_momentum =
      norm(after.angular_momentum - before.angular_momentum) / norm(before.angular_momentum);
  return history;
}

TEST_P(InMotion, KeepsMomentaAndEnergy) {
  if (size_of(PETSC_COMM_WORLD) > 1) GTEST_SKIP() << "DoesNotDependOnTheNumberOfRanks";
  for (const Material& material :
       {Material(RotatedLinear{.lame = reference_lame}), Material(NeoHookean{.lame = reference_lame})}) {
    const auto moving_body = simulation(material);
    KeptEnergy energy(*moving_body, moving(moving_body->mesh(), GetParam(), material));
    const auto history = history_of(*moving_body, energy, GetParam().time_step);
    EXPECT_LE(history.strain, 0.2);
    EXPECT_LE(history.momentum, 1e-11);
    EXPECT_LE(history.angular_momentum, 1e-9);
    EXPECT_LE(history.energy, 0.02);
    if (!std::holds_alternative<NeoHookean>(material)) continue;
    tell("largest strain in 2000 steps", "at most 0.2", history.strain, "");
    tell("change of momentum in 2000 steps, relative", "0", history.momentum, "1e-11");
    tell("change of angular momentum in 2000 steps, relative", "0", history.angular_momentum, "1e-9");
    tell("change of the kept energy in 1500 steps, relative", "0", history.energy, "0.02");
  }
}

TEST_P(InMotion, BlowsUpWithoutTheFilter) {
  if (size_of(PETSC_COMM_WORLD) > 1) GTEST_SKIP() << "the same on any number";
  const auto body = simulation(RotatedLinear{.lame = reference_lame}, false);
  const auto before = body->measure();
  const auto steps = [&] {
    for (int step = 0; step < 200; ++step) body->step(GetParam().time_step);
    const auto after = body->measure();
    if (after.kinetic_energy > 10 * (before.kinetic_energy + before.elastic_energy))
      throw SimulationError("fast");
  };
  EXPECT_THROW(steps(), SimulationError);
}

/// Every rank compares with what it computes when it has the whole mesh to itself.
TEST_P(InMotion, DoesNotDependOnTheNumberOfRanks) {
  const NeoHookean material{.lame = reference_lame};
  const auto shared = simulation(material), whole = simulation(material, true, PETSC_COMM_SELF);
  const auto after = test::after_steps(*shared, 200);
  const double difference = test::largest_difference(after, test::after_steps(*whole, 200));
  EXPECT_LE(difference, 1e-9);
  if (size_of(PETSC_COMM_WORLD) > 1)
    tell("positions after 200 steps on one rank and on several [m]", "the same", difference, "1e-9");
}

/// Four times the stiffness makes more elements too fast: they are filtered from then on.
TEST_P(InMotion, FollowsAnEventThatStiffensTheMaterial) {
  const auto body = simulation(NeoHookean{.lame = reference_lame});
  const auto filtered = [&] {
    GlobalIndex count = body->filter()->filtered_cells();
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, body->mesh().comm);
    return count;
  };
  for (int step = 0; step < 20; ++step) body->step(GetParam().time_step);
  const auto before = filtered();
  const Lame stiffer = Lame::from_young_poisson(4e4, 0.3);
  for (std::size_t r = 0; r < body->mesh().regions.size(); ++r)
    body->set_properties(static_cast<std::int32_t>(r), {GetParam().density, NeoHookean{.lame = stiffer}, {}});
  EXPECT_GE(filtered(), before);
  for (int step = 0; step < 200; ++step) body->step(GetParam().time_step);
  EXPECT_EQ(body->inverted_points(), 0);
}

INSTANTIATE_TEST_SUITE_P(Meshes, InMotion, testing::ValuesIn(motions), [](const auto& of) {
  return std::string(of.param.mesh) + "_" + name_of(of.param.selection);
});

/// The true limit of the filtered stack, and what is gained.
TEST(WedgeStack, TakesMoreThanFiveTimesTheStep) {
  const auto path = test::shared_mesh("wedge_stack.msh");
  if (!path) GTEST_SKIP() << "wedge_stack.msh is not in EVERT_SHARED_MESHES";
  const auto mesh = test::distributed(*path);
  ElasticForces elastic(
      mesh,
      std::vector(mesh.regions.size(), ElasticProperties{0.05, RotatedLinear{.lame = reference_lame}, {}}));
  NodeField x(mesh);
  for (LocalIndex i = 0; i < mesh.local_nodes(); ++i)
    set_node_value(x.local(), i, mesh.rest_positions[static_cast<std::size_t>(i)]);
  const auto limit = [&] {
    MassScaledStiffness stiffness(mesh, elastic);
    stiffness.assemble(x);
    return step_limit(fastest_mode(stiffness).squared_frequency);
  };
  const double before = limit();
  const ModalFilter filter(mesh, elastic, {.time_step = 0.7e-3, .safety = 1, .selection = paper});
  const double after = limit();
  EXPECT_NEAR(after, 0.982e-3, 0.005 * 0.982e-3);
  EXPECT_GE(0.7e-3 / before, 5);
  test::verify("modal filter: wedge stack, true limit [ms] when filtered for 0.7 ms", "0.982 (prototype)",
               1e3 * after, "0.5 %");
  test::verify("modal filter: wedge stack, 0.7 ms over its limit without a filter", "at least 5",
               0.7e-3 / before, "");
}

}  // namespace
}  // namespace evert
