#include "evert/elements/rest_shape.hpp"
#include "evert/forces/kernels/force_kernels.hpp"
#include "evert/forces/kernels/measure_kernels.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "fibre_model.hpp"
#include "reference_forces.hpp"

/// The path of models that need U and V, by one that the library does not know.
namespace evert::test {
namespace {

/// Kernels of any model on batches of T.
template <class T, const auto& element>
class Kernels {
 public:
  static constexpr ShapeData shape_data =
      element.tensor_product ? ShapeData::inverse_jacobian : ShapeData::node_gradients;

  explicit Kernels(const Body& body)
      : block_(make_element_block(element, body.nodes, body.cells() / 2, body.rest,
                                  static_cast<int>(lanes_v<T>), shape_data)) {
    arrays_.nodes = block_.nodes.data();
    arrays_.shapes = block_.shapes.data();
    arrays_.volumes = block_.volumes.data();
  }

  template <class Model>
  [[nodiscard]] NodalValues forces(const Model& model, const NodalValues& x) const {
    NodalValues f(x.size(), 0.0);
    kernels::add_forces<T, element, DampingModel::none>(model, arrays_, x.data(), f.data(),
                                                        {0, block_.batches()});
    return f;
  }
  template <class Model>
  [[nodiscard]] double energy(const Model& model, const NodalValues& x) const {
    return kernels::sum_of_energy<T, element>(model, arrays_, x.data(), {0, block_.batches()});
  }

 private:
  ElementBlock block_;
  kernels::BlockArrays arrays_{};
};

Body small_body(CellType type) { return type == CellType::tet4 ? box(type, 1, 2, 2) : box(type, 2, 1, 1); }

using kernels::InFrames;

const FibreModel muscle{NeoHookean{.lame = soft}, 2e4, Vec3d{0.6, 0, 0.8}};

/// Calls `check(kernels, body)` for packs of every element, and for scalars of two.
template <class Check>
void for_each_kernel(Check&& check) {
  const auto on = [&]<class T, const auto & element>() {
    const Body body = small_body(element.type);
    check(Kernels<T, element>(body), body);
  };
  on.template operator()<double, tet4>();
  on.template operator()<double, hex8>();
  on.template operator()<Pack, tet4>();
  on.template operator()<Pack, hex8_by_gradients>();
  on.template operator()<Pack, hex8>();
  on.template operator()<Pack, wedge6>();
  on.template operator()<Pack, tet10>();
}

TEST(GeneralStress, IsTakenByWhatAModelOffers) {
  static_assert(kernels::NeedsFrames<FibreModel>);
  static_assert(kernels::NeedsFrames<InFrames<NeoHookean>>);
  static_assert(!kernels::NeedsFrames<NeoHookean>);
  static_assert(!kernels::NeedsFrames<RotatedLinear>);
  static_assert(!kernels::NeedsFrames<StVenantKirchhoff>);
  static_assert(!kernels::NeedsFrames<MooneyRivlin>);
}

TEST(GeneralStress, OfAnIsotropicModelIsThatOfTheShortPath) {
  for_each_kernel([](const auto& kernels, const Body& body) {
    const auto compare = [&](const auto& model) {
      for (const State& state : awkward_states(body)) {
        if (!state.unique) continue;
        const ReferenceForces reference = reference_forces(body, model, state.x);
        const NodalValues expected = kernels.forces(model, state.x);
        const NodalValues f = kernels.forces(InFrames{model}, state.x);
        for (std::size_t i = 0; i + 1 < f.size(); ++i)
          EXPECT_NEAR(f[i], expected[i], 1e-14 * static_cast<double>(reference.stiffness[i / 3]))
              << model.name << ", " << state.name;
        const double energy = kernels.energy(model, state.x);
        EXPECT_NEAR(kernels.energy(InFrames{model}, state.x), energy, 1e-13 * energy) << state.name;
      }
    };
    compare(NeoHookean{.lame = soft});
    compare(RotatedLinear{.lame = soft});
    compare(StVenantKirchhoff{.lame = soft});
    compare(MooneyRivlin{.lame = soft});
    compare(Spline{.lame = soft});
    compare(StableNeoHookean{.lame = soft});
  });
}

/// Without any SVD: P = P_nh + k (|F a|² − 1) F a aᵀ and its energy, in long double. The model's fibre is one
/// of cells as they are turned; in the world it is Q a.
TEST(GeneralStress, OfFibresIsTheFormula) {
  for_each_kernel([](const auto& kernels, const Body& body) {
    for (const State& state : awkward_states(body)) {
      if (!state.unique) continue;
      ReferenceForces reference = reference_forces(body, muscle.matrix, state.x);
      with_reference_element(
          body.type, [&]<int nodes, int points>(const ReferenceElement<nodes, points>& element) {
            for (LocalIndex c = 0; c < body.cells(); ++c) {
              for (std::size_t q = 0; q < points; ++q) {
                Mat3<Real80> rest{}, now{};
                for (std::size_t n = 0; n < nodes; ++n) {
                  const auto gradient = converted<Real80>(element.gradients[q][n]);
                  const auto node = static_cast<std::size_t>(body.cell(c)[n]);
                  rest += outer(converted<Real80>(body.rest[node]), gradient);
                  now += outer(converted<Real80>(at_node(state.x, node)), gradient);
                }
                const Real80 volume = determinant(rest) * element.weights[q];
                const ElementView view(element);
                const RestVectors vectors(view, kernels.shape_data, q,
                                          rest_jacobian(view, q, body.cell(c), body.rest));
                const auto a = converted<Real80>(vectors.frame() * muscle.fibre);
                const Vec3<Real80> fa = (now * inverse(rest)) * a;
                const Real80 excess = dot(fa, fa) - 1;
                reference.energy += volume * muscle.stiffness / 4 * excess * excess;
                for (std::size_t n = 0; n < nodes; ++n) {
                  const auto node = static_cast<std::size_t>(body.cell(c)[n]);
                  const auto g = transpose_times(inverse(rest), converted<Real80>(element.gradients[q][n]));
                  const Vec3<Real80> force = (volume * muscle.stiffness * excess * dot(a, g)) * fa;
                  reference.forces[node] -= force;
                  reference.magnitude[node] +=
                      volume * muscle.stiffness * (1 + dot(fa, fa)) * norm(fa) * norm(g);
                }
              }
            }
          });
      EXPECT_LE(relative_error(kernels.forces(muscle, state.x), reference), 1e-13) << state.name;
      EXPECT_NEAR(kernels.energy(muscle, state.x) / static_cast<double>(reference.energy), 1, 1e-12)
          << state.name;
    }
  });
}

TEST(GeneralStress, IsTheGradientOfTheEnergy) {
  for_each_kernel([](const auto& kernels, const Body& body) {
    for (const State& state : awkward_states(body)) {
      if (!state.unique) continue;
      const auto energy = [&](const NodalValues& x) { return kernels.energy(muscle, x); };
      expect_gradient(kernels.forces(muscle, state.x), energy, state.x, state.name);
    }
  });
}

/// Fibres turn with the body: f(R x) = R f(x). Turned at rest instead, they do not.
TEST(GeneralStress, IsObjectiveAndNotIsotropic) {
  const Mat3d turn = rotation(2.1);
  for_each_kernel([&](const auto& kernels, const Body& body) {
    for (const State& state : awkward_states(body)) {
      if (!state.unique) continue;
      const NodalValues f = kernels.forces(muscle, state.x);
      std::vector<Vec3d> turned, expected;
      for (std::size_t node = 0; node < body.rest.size(); ++node) {
        turned.push_back(turn * at_node(state.x, node));
        expected.push_back(turn * at_node(f, node));
      }
      // Positions are rounded to 1e-16 of where they are: a strain of 1e-15 in cells of a tenth.
      EXPECT_LE(largest_difference(kernels.forces(muscle, nodal_values(turned)), nodal_values(expected)),
                3e-12 * (largest(f) + soft.mu * 0.01))
          << state.name;
    }
    const NodalValues bent = awkward_states(body).front().x;
    const FibreModel across{muscle.matrix, muscle.stiffness, Vec3d{0, 1, 0}};
    const NodalValues f = kernels.forces(muscle, bent);
    EXPECT_GT(largest_difference(kernels.forces(across, bent), f), 0.1 * largest(f));
  });
}

}  // namespace
}  // namespace evert::test
