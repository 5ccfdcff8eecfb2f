#include <gtest/gtest.h>

#include "bodies.hpp"
#include "reference_forces.hpp"

/// Elements with fibres: a direction of its own in every cell, and activation. Muscle that is not active and
/// tendon are among the models of the other suites.
namespace evert::test {
namespace {

Body small_body(CellType type) { return type == CellType::tet4 ? box(type, 2, 2, 2) : box(type, 3, 2, 2); }

std::string label(const Body& body, double activation, const State& state) {
  return std::string(evert::name_of(body.type)) + ", " + std::to_string(activation) + ", " + state.name;
}

/// Calls `check(body, activation)` for every element.
template <class Check>
void for_each_muscle(Check&& check) {
  for (const CellType type : all_elements)
    for (const double activation : {0.3, 1.0}) check(small_body(type), activation);
}

TEST(Fibres, ForcesOfActiveMuscleAgreeWithLongDouble) {
  for_each_muscle([](const Body& body, double activation) {
    const Material material = active_muscle(activation);
    for (const auto& level : supported_levels()) {
      const auto block = level_block(level, body, material, no_damping, 5);
      for (const State& state : awkward_states(body)) {
        if (!state.unique) continue;
        const ReferenceForces reference = reference_forces(body, material, state.x);
        EXPECT_LE(relative_error(forces(*block, state.x), reference), 1e-13)
            << label(body, activation, state) << ", " << level.name;
        // The energy of active muscle has both signs.
        const double scale = static_cast<double>(std::abs(reference.energy)) + soft.mu * 8e-3;
        EXPECT_NEAR(block->energy(state.x.data()), static_cast<double>(reference.energy), 1e-12 * scale)
            << label(body, activation, state) << ", " << level.name;
      }
    }
  });
}

TEST(Fibres, ForcesOfActiveMuscleHaveNoResultantAndNoTorque) {
  for_each_muscle([](const Body& body, double activation) {
    const auto block =
        make_elastic_block(body.elastic_cells(), body.rest, active_muscle(activation), no_damping);
    for (const State& state : awkward_states(body))
      expect_balance(state.x, forces(*block, state.x), label(body, activation, state));
  });
}

/// In a cube at rest that is active along a fibre, only the faces across it are pulled at, by the peak
/// stress.
TEST(Fibres, PullAlongTheirOwnDirection) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Body body = box(CellType::hex8, 1, 1, 1, 0.1, 0);
    body.fibres.front() = {};
    body.fibres.front()[axis] = 1;
    const Muscle muscle = active_muscle(1);
    const auto block = make_elastic_block(body.elastic_cells(), body.rest, muscle, no_damping);
    const NodalValues f = forces(*block, nodal_values(body.rest));
    const double corner = muscle.peak_stress * 0.1 * 0.1 / 4;
    for (std::size_t node = 0; node < 8; ++node) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double towards = body.rest[node][axis] > 0.05 ? -corner : corner;
        EXPECT_NEAR(f[3 * node + i], i == axis ? towards : 0, 1e-13 * corner);
      }
    }
  }
}

TEST(Fibres, SetActivationIsAsIfMadeAnew) {
  const Body body = small_body(CellType::tet4);
  const NodalValues x = awkward_states(body)[1].x;
  const auto changed = make_elastic_block(body.elastic_cells(), body.rest, active_muscle(0), no_damping);
  for (const double activation : {0.4, 1.0, 0.0}) {
    changed->set_activation(activation);
    const auto made =
        make_elastic_block(body.elastic_cells(), body.rest, active_muscle(activation), no_damping);
    EXPECT_EQ(largest_difference(forces(*changed, x), forces(*made, x)), 0);
    EXPECT_EQ(changed->energy(x.data()), made->energy(x.data()));
    EXPECT_EQ(changed->stable_step(x.data()).undamped, made->stable_step(x.data()).undamped);
  }
  for (const Material& material : all_materials()) {
    if (std::holds_alternative<Muscle>(material)) continue;
    const auto block = make_elastic_block(body.elastic_cells(), body.rest, material, no_damping);
    const NodalValues before = forces(*block, x);
    block->set_activation(1);
    EXPECT_EQ(largest_difference(forces(*block, x), before), 0) << name_of(material);
  }
}

TEST(Fibres, TakeMemoryOnlyWhereThereAreSome) {
  for (const CellType type : all_elements) {
    const Body body = box(type, 4, 2, 2);
    const auto bytes = [&](const Material& material) {
      return make_elastic_block(body.elastic_cells(), body.rest, material, no_damping)->memory();
    };
    const std::size_t without = bytes(MooneyRivlin{.lame = soft});
    const auto points = static_cast<std::size_t>(body.cells() * points_per_cell(type));
    EXPECT_GE(bytes(active_muscle(0)), without + 3 * sizeof(double) * points);
    EXPECT_LE(bytes(active_muscle(0)), without + 3 * sizeof(double) * (points + 64));  // padding
    EXPECT_EQ(bytes(NeoHookean{.lame = soft}), without);
  }
}

}  // namespace
}  // namespace evert::test
