// Manufactured solutions: a smooth large deformation is given, the body force that it needs is worked out,
// and the error of what comes out must fall with the size of the elements as theory says.
#include "evert/mesh/boundary.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/quadratic.hpp"
#include "evert/sim/simulation.hpp"

#include <gtest/gtest.h>

#include "tests/support/petsc_options.hpp"
#include "tests/support/quadrature.hpp"
#include "tests/support/ranks.hpp"
#include "tests/support/verify.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace evert {
namespace {

constexpr double density = 1;  // [kg/m^3]
const Lame lame = Lame::from_young_poisson(1, 0.3);

/// Of the unit cube at share `s` of the whole motion: bends, stretches and shears by up to a third.
Vec3d displacement(const Vec3d& x, double s) {
  using std::numbers::pi;
  return s * Vec3d{0.15 * std::sin(pi * x[1]) + 0.1 * x[0] * x[2],
                   0.12 * std::sin(pi * x[0]) * std::cos(x[2]),
                   0.1 * std::sin(2 * x[0] + x[1]) + 0.1 * x[2] * x[2]};
}

/// Central differences of fourth order, whose error here is that of rounding, 1e-12.
template <class Function>
auto derivative(Function&& function, const Vec3d& x, std::size_t axis) {
  constexpr double h = 1e-3;
  const auto at = [&](double steps) {
    Vec3d moved = x;
    moved[axis] += steps * h;
    return function(moved);
  };
  return (1 / (12 * h)) * (8.0 * (at(1) - at(-1)) - (at(2) - at(-2)));
}

Mat3d deformation_gradient(const Vec3d& x, double s) {
  Mat3d f = identity<double>();
  for (std::size_t j = 0; j < 3; ++j)
    f.column[j] += derivative([s](const Vec3d& p) { return displacement(p, s); }, x, j);
  return f;
}

/// Compressible neo-Hookean by its textbook formula, without any diagonalisation.
Mat3d first_piola(const Mat3d& f) {
  const Mat3d inverse_transpose = transpose(inverse(f));
  return lame.mu * (f - inverse_transpose) + (lame.lambda * std::log(determinant(f))) * inverse_transpose;
}

/// −Div P, what holds the deformation.
Vec3d static_force(const Vec3d& x, double s) {
  Vec3d force{};
  for (std::size_t j = 0; j < 3; ++j)
    force -=
        derivative([s](const Vec3d& p) { return first_piola(deformation_gradient(p, s)); }, x, j).column[j];
  return force;
}

/// The unit cube with n cells along each edge, smoothly distorted.
Mesh cube(const std::string& element, int n) {
  using std::numbers::pi;
  const auto cells = element == "hex8"     ? BoxCells::hex8
                     : element == "wedge6" ? BoxCells::wedge6
                                           : BoxCells::tet6;
  Mesh mesh = generate_box({1, 1, 1}, {n, n, n}, cells);
  Vec3d lower = mesh.nodes.front();
  for (const auto& node : mesh.nodes)
    for (std::size_t k = 0; k < 3; ++k) lower[k] = std::min(lower[k], node[k]);
  for (auto& node : mesh.nodes) {
    node -= lower;
    const double bump = 0.05 * std::sin(pi * node[0]) * std::sin(pi * node[1]) * std::sin(pi * node[2]);
    node += Vec3d{bump, -bump, 0.5 * bump};
  }
  if (element == "tet10") make_quadratic(mesh);
  return mesh;
}

struct Errors {
  double position = 0;  // L2 norm [m]
  double stress = 0;    // L2 norm of the error of P [Pa]
};

Errors errors_of(const Simulation& simulation, double s) {
  const auto& mesh = simulation.mesh();
  NodeField x(mesh);
  std::copy(simulation.positions().owned().begin(), simulation.positions().owned().end(), x.owned().begin());
  x.touched();
  simulation.elastic().halo().begin_update(x);
  simulation.elastic().halo().end_update(x);
  std::array<double, 2> sums{};
  test::for_each_point(mesh, x.local(), [&](const test::QuadraturePoint& point) {
    const Vec3d off = point.position - point.rest - displacement(point.rest, s);
    const Mat3d stress =
        first_piola(point.deformation_gradient) - first_piola(deformation_gradient(point.rest, s));
    sums[0] += point.volume * dot(off, off);
    sums[1] += point.volume * contract(stress, stress);
  });
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, mesh.comm);
  return {std::sqrt(sums[0]), std::sqrt(sums[1])};
}

/// Every node of the surface has the exact motion, `keys` giving its velocity from its whole displacement.
template <class Keys>
std::vector<PrescribedNodes> exact_surface(const DistributedMesh& mesh, const Mesh& whole, Keys&& keys) {
  const auto surface = boundary_nodes(whole);
  std::vector<PrescribedNodes> groups;
  for (LocalIndex i = 0; i < mesh.owned_nodes; ++i) {
    const auto node = static_cast<std::size_t>(i);
    if (!std::binary_search(surface.begin(), surface.end(), mesh.original_nodes[node])) continue;
    groups.push_back({.nodes = {i}, .keyframes = keys(displacement(mesh.rest_positions[node], 1))});
  }
  return groups;
}

Errors static_errors(const std::string& element, int n) {
  const Mesh whole = cube(element, n);
  auto mesh = distribute(PETSC_COMM_WORLD, whole);
  SimulationDefinition definition;
  definition.properties = {{.density = density, .material = NeoHookean{.lame = lame}, .damping = {}}};
  definition.prescribed = exact_surface(mesh, whole, [](const Vec3d& d) {
    return std::vector<VelocityKeyframe>{{0, d}};
  });
  definition.body_force = [](const Vec3d& x, double t) { return static_force(x, t); };
  definition.method = IntegrationMethod::quasistatic;
  Simulation simulation(std::move(mesh), std::move(definition));
  simulation.step_to(1);
  return errors_of(simulation, 1);
}

/// How the deformation grows with time. Velocities of the surface are linear in time in both, and so exact.
enum class Growth {
  steady,       ///< as t: nothing is accelerated
  accelerated,  ///< as t²
};

Errors dynamic_errors(const std::string& element, int n, int steps, Growth growth,
                      MassForm mass = MassForm::lumped) {
  const bool steady = growth == Growth::steady;
  const Mesh whole = cube(element, n);
  auto mesh = distribute(PETSC_COMM_WORLD, whole);
  SimulationDefinition definition;
  definition.mass = mass;
  definition.properties = {{.density = density, .material = NeoHookean{.lame = lame}, .damping = {}}};
  definition.prescribed = exact_surface(mesh, whole, [steady](const Vec3d& d) {
    return steady ? std::vector<VelocityKeyframe>{{0, d}}
                  : std::vector<VelocityKeyframe>{{0, {}}, {1, 2.0 * d}};
  });
  definition.body_force = [steady](const Vec3d& x, double t) {
    return steady ? static_force(x, t) : static_force(x, t * t) + (2 * density) * displacement(x, 1);
  };
  for (LocalIndex i = 0; i < mesh.owned_nodes; ++i) {
    const auto& rest = mesh.rest_positions[static_cast<std::size_t>(i)];
    definition.initial_positions.push_back(rest);
    definition.initial_velocities.push_back(steady ? displacement(rest, 1) : Vec3d{});
  }
  Simulation simulation(std::move(mesh), std::move(definition));
  for (int step = 1; step <= steps; ++step) simulation.step_to(static_cast<double>(step) / steps);
  return errors_of(simulation, 1);
}

/// Slope of log(error) over log(h), by least squares.
double fitted_order(std::span<const int> n, std::span<const double> errors) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto count = static_cast<double>(n.size());
  for (std::size_t i = 0; i < n.size(); ++i) {
    const double x = -std::log(n[i]), y = std::log(errors[i]);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

struct Expected {
  const char* element;
  std::vector<int> n;
  double position, stress;  // orders at least; 0: nothing is expected
};

template <class Solve>
void expect_orders(const char* kind, const Expected& expected, Solve&& solve) {
  std::vector<double> position, stress;
  for (const int n : expected.n) {
    const Errors errors = solve(n);
    position.push_back(errors.position);
    stress.push_back(errors.stress);
    if (rank_of(PETSC_COMM_WORLD) == 0)
      std::printf("%s %-6s %2d cells an edge: error of positions %.4e, of stress %.4e\n", kind,
                  expected.element, n, errors.position, errors.stress);
  }
  const auto check_order = [&](const char* what, double least, std::span<const double> errors) {
    const double order = fitted_order(expected.n, errors);
    std::array<char, 96> text{}, bound{};
    std::snprintf(text.data(), text.size(), "manufactured solution, %s, %s: order of %s in L2", kind,
                  expected.element, what);
    std::snprintf(bound.data(), bound.size(), ">= %.1f", least);
    test::verify(text.data(), std::to_string(static_cast<int>(std::ceil(least))), order, bound.data());
    EXPECT_GE(order, least) << text.data();
  };
  check_order("positions", expected.position, position);
  if (expected.stress > 0) check_order("stress", expected.stress, stress);
}

class StaticOrder : public testing::TestWithParam<Expected> {};

TEST_P(StaticOrder, IsThatOfTheory) {
  if (test::shown_on_one_rank() && GetParam().element != std::string("hex8"))
    GTEST_SKIP() << "shown on one rank";
  const auto solver = test::quasistatic_solver();
  expect_orders("static", GetParam(), [&](int n) { return static_errors(GetParam().element, n); });
}

std::string name_of(const testing::TestParamInfo<Expected>& info) { return info.param.element; }

INSTANTIATE_TEST_SUITE_P(All, StaticOrder,
                         testing::Values(Expected{"tet4", {4, 6, 10}, 1.9, 0.9},
                                         Expected{"hex8", {4, 6, 10}, 1.9, 0.9},
                                         Expected{"wedge6", {4, 6, 10}, 1.9, 0.9},
                                         Expected{"tet10", {2, 3, 5}, 2.8, 1.8}),
                         name_of);

class DynamicOrders : public testing::TestWithParam<Expected> {};

// Steps well below the stable one, so that what is seen is the error of the elements.
constexpr int steps_a_cell = 15;

TEST_P(DynamicOrders, IsThatOfTheory) {
  if (test::shown_on_one_rank() && GetParam().element != std::string("tet4"))
    GTEST_SKIP() << "shown on one rank";
  expect_orders("dynamic", GetParam(), [&](int n) {
    return dynamic_errors(GetParam().element, n, steps_a_cell * n, Growth::accelerated);
  });
}

INSTANTIATE_TEST_SUITE_P(All, DynamicOrders,
                         testing::Values(Expected{"tet4", {3, 5, 8}, 1.9, 0.9},
                                         Expected{"hex8", {3, 5, 8}, 1.9, 0.9},
                                         Expected{"wedge6", {3, 5, 8}, 1.9, 0.9}),
                         name_of);

// No lumped masses of tet10 that are positive are consistent: accelerations have an error of second order in
// the positions, and of first order or less in the stress. Without acceleration it is the element's own.
TEST(DynamicOrder, OfTet10IsTheElementsOwnWhereNothingAccelerates) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  expect_orders("dynamic, unaccelerated", Expected{"tet10", {2, 3, 5}, 2.8, 1.8},
                [](int n) { return dynamic_errors("tet10", n, 40 * n, Growth::steady); });
}

TEST(DynamicOrder, OfTet10IsThatOfItsLumpedMassesWhereItAccelerates) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  expect_orders("dynamic, accelerated", Expected{"tet10", {2, 3, 5}, 1.9, 0},
                [](int n) { return dynamic_errors("tet10", n, 40 * n, Growth::accelerated); });
}

class ConsistentOrders : public testing::TestWithParam<Expected> {};

/// The scheme is exact for motions of second degree in time, whatever the steps, if they are stable. The
/// solves are good to a thousandth of the smallest error.
TEST_P(ConsistentOrders, AreThoseOfTheoryWhereItAccelerates) {
  if (test::shown_on_one_rank() && GetParam().element != std::string("wedge6"))
    GTEST_SKIP() << "shown on one rank";
  const test::Options tolerance{{"-damping_ksp_rtol", "1e-6"}};
  const int steps = GetParam().element == std::string("tet10") ? 20 : 8;
  expect_orders("dynamic, consistent masses", GetParam(), [&](int n) {
    return dynamic_errors(GetParam().element, n, steps * n, Growth::accelerated, MassForm::consistent);
  });
}

INSTANTIATE_TEST_SUITE_P(All, ConsistentOrders,
                         testing::Values(Expected{"tet4", {3, 5, 8}, 1.9, 0.9},
                                         Expected{"hex8", {3, 5, 8}, 1.9, 0.9},
                                         Expected{"wedge6", {3, 5, 8}, 1.9, 0.9},
                                         Expected{"tet10", {2, 3, 5}, 2.8, 1.8}),
                         name_of);

}  // namespace
}  // namespace evert
