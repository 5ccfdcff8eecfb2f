// The constraints of paper B: which there are, how they are projected, what is kept.
#include "evert/core/error.hpp"
#include "evert/integrators/shape_projection.hpp"
#include "evert/math/nodal.hpp"
#include "evert/mesh/cell_geometry.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include "tests/support/shared_meshes.hpp"
#include "tests/support/verify.hpp"
#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace evert {
namespace {

constexpr Lame reference_lame = Lame::from_young_poisson(1e4, 0.3);
constexpr double stack_step = 0.7e-3;  // [s]

/// Of this rank, in lengths.
double largest_violation(const std::vector<ShapeConstraint>& constraints, const NodeField& x) {
  double largest = 0;
  TetRow gradient;
  for (const auto& constraint : constraints)
    largest = std::max(largest, std::abs(violation(constraint, x.local(), gradient)) / constraint.rest);
  return largest;
}

/// A mesh with filtered elements and their constraints.
struct Constrained {
  DistributedMesh mesh;
  ElasticForces elastic;
  ModalFilter filter;
  ShapeProjection projection;

  Constrained(const std::string& path, double density, double time_step, FilterProjection form)
      : mesh(test::distributed(path)),
        elastic(mesh, std::vector(mesh.regions.size(),
                                  ElasticProperties{density, RotatedLinear{.lame = reference_lame}, {}})),
        filter(mesh, elastic,
               {.time_step = time_step,
                .selection = FilterSelection::paper,
                .constraints = FilterConstraints::paper,
                .projection = form}),
        projection(mesh, elastic, filter) {}

  [[nodiscard]] NodeField at_rest() const {
    NodeField x(mesh);
    for (LocalIndex i = 0; i < mesh.local_nodes(); ++i)
      set_node_value(x.local(), i, mesh.rest_positions[static_cast<std::size_t>(i)]);
    return x;
  }
  [[nodiscard]] GlobalIndex constraints() const {
    auto count = static_cast<GlobalIndex>(filter.shape_constraints().size());
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, mesh.comm);
    return count;
  }
  /// Collective. In lengths.
  [[nodiscard]] double largest_violation(NodeField& x) const {
    elastic.halo().begin_update(x);
    elastic.halo().end_update(x);
    double largest = evert::largest_violation(filter.shape_constraints(), x);
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
    return largest;
  }
};

TEST(ShapeConstraint, HasTheGradientOfItsViolation) {
  const std::array<double, 12> x{0.1, 0.2, 0.3, 1.1, 0.1, -0.1, 0.2, 0.9, 0.1, 0.3, 0.2, 0.7};
  for (const ShapeConstraint& constraint :
       {ShapeConstraint{{0, 2, -1, -1}, 0.7}, ShapeConstraint{{3, 0, 1, 2}, 0.4},
        ShapeConstraint{{1, 3, 0, 2}, 0.4}}) {
    TetRow gradient, unused;
    static_cast<void>(violation(constraint, x, gradient));
    for (std::size_t a = 0; a < 4; ++a) {
      if (constraint.nodes[a] < 0) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        constexpr double h = 1e-6;
        auto more = x, less = x;
        more[3 * static_cast<std::size_t>(constraint.nodes[a]) + k] += h;
        less[3 * static_cast<std::size_t>(constraint.nodes[a]) + k] -= h;
        const double slope =
            (violation(constraint, more, unused) - violation(constraint, less, unused)) / (2 * h);
        EXPECT_NEAR(gradient[a][k], slope, 1e-8);
      }
    }
  }
}

/// All edges of the filtered elements of this rank.
std::vector<ShapeConstraint> all_edges(const Constrained& body) {
  std::set<std::pair<LocalIndex, LocalIndex>> edges;
  auto clamp = body.filter.clamps().begin();
  for (const auto& entry : body.mesh.cells)
    for (std::size_t first = 0; first < entry.nodes.size(); first += 4)
      if ((clamp++)->limit > 0)
        for (const auto& [a, b] : edges_of_tet)
          edges.insert(std::minmax(entry.nodes[first + a], entry.nodes[first + b]));
  std::vector<ShapeConstraint> constraints;
  for (const auto& [a, b] : edges) {
    const auto at = [&](LocalIndex node) { return body.mesh.rest_positions[static_cast<std::size_t>(node)]; };
    constraints.push_back({{a, b, -1, -1}, norm(at(b) - at(a))});
  }
  return constraints;
}

/// Of J at rest.
Eigen::Index rank_of_rows(const Constrained& body, const std::vector<ShapeConstraint>& constraints) {
  const auto x = body.at_rest();
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(Eigen::Index(constraints.size()), 3 * body.mesh.owned_nodes);
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    TetRow row;
    EXPECT_NEAR(violation(constraints[k], x.local(), row), 0, 1e-15);
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t i = 0; i < 3; ++i)
        if (constraints[k].nodes[a] >= 0)
          j(Eigen::Index(k), 3 * constraints[k].nodes[a] + Eigen::Index(i)) += row[a][i];
  }
  Eigen::FullPivLU<Eigen::MatrixXd> lu(j);
  lu.setThreshold(1e-9);
  return lu.rank();
}

/// Its wedges share no short edge; all edges of theirs are 21, none of which depends on the others.
TEST(WedgeStack, HasIndependentEdges) {
  const auto path = test::shared_mesh("wedge_stack.msh");
  if (!path) GTEST_SKIP() << "wedge_stack.msh is not in EVERT_SHARED_MESHES";
  if (size_of(PETSC_COMM_WORLD) > 1) GTEST_SKIP() << "looks at the whole of J";
  const Constrained stack(*path, 0.05, stack_step, FilterProjection::shake);
  const auto& kept = stack.filter.shape_constraints();
  const auto all = all_edges(stack);
  EXPECT_EQ(kept.size(), static_cast<std::size_t>(stack.filter.filtered_cells()));
  EXPECT_EQ(rank_of_rows(stack, kept), Eigen::Index(kept.size()));
  EXPECT_EQ(all.size(), 21U);
  EXPECT_EQ(rank_of_rows(stack, all), 21);
  test::verify("paper constraints: wedge stack, edges of its filtered wedges", "21",
               static_cast<double>(all.size()), "");
  test::verify("paper constraints: wedge stack, rank of these", "21",
               static_cast<double>(rank_of_rows(stack, all)), "");
  test::verify("paper constraints: wedge stack, short edges that are kept, one a wedge", "independent",
               static_cast<double>(kept.size()), "");
}

/// A displacement that strains everything.
Vec3d wave(const Vec3d& p) { return {std::sin(9 * p[1]), std::sin(7 * p[2]), std::sin(8 * p[0])}; }

std::string form_name(FilterProjection form) {
  return form == FilterProjection::shake ? "shake" : "goldenthal";
}

/// A velocity that strains the stack and turns it [m/s].
Vec3d initial_velocity(const Vec3d& p) {
  return 0.1 * (Vec3d{1, 2, 0.5} + cross(Vec3d{0.3, 1, -0.5}, p)) +
         0.05 * Vec3d{p[0] + 0.5 * p[1], -0.5 * p[1], -0.4 * p[0]};
}

std::unique_ptr<Simulation> moving_stack(const std::string& path, FilterProjection form,
                                         MPI_Comm comm = PETSC_COMM_WORLD, double speed = 1, int sweeps = 0) {
  auto mesh = test::distributed(path, comm);
  SimulationDefinition definition;
  definition.properties.assign(mesh.regions.size(), {0.05, RotatedLinear{.lame = reference_lame}, {}});
  definition.fixed_time_step = stack_step;
  definition.filter = {.time_step = stack_step,
                       .selection = FilterSelection::paper,
                       .constraints = FilterConstraints::paper,
                       .projection = form,
                       .projection_sweeps = sweeps};
  for (LocalIndex i = 0; i < mesh.owned_nodes; ++i)
    definition.initial_velocities.push_back(
        speed * initial_velocity(mesh.rest_positions[static_cast<std::size_t>(i)]));
  return std::make_unique<Simulation>(std::move(mesh), std::move(definition));
}

TEST(WedgeStack, IsProjectedInThreeIterationsAndKeepsMomenta) {
  const auto path = test::shared_mesh("wedge_stack.msh");
  if (!path) GTEST_SKIP() << "wedge_stack.msh is not in EVERT_SHARED_MESHES";
  if (size_of(PETSC_COMM_WORLD) > 1) GTEST_SKIP() << "DoesNotDependOnTheNumberOfRanks";
  for (const auto form : {FilterProjection::shake, FilterProjection::goldenthal}) {
    const auto body = moving_stack(*path, form);
    const auto before = body->measure();
    int most = 0;
    for (int step = 0; step < 2000; ++step)
      most = std::max(most, body->step(stack_step).projection_iterations);
    const auto after = body->measure();
    const double momentum = norm(after.momentum - before.momentum) / norm(before.momentum);
    const double angular =
        norm(after.angular_momentum - before.angular_momentum) / norm(before.angular_momentum);
    const std::string name = form_name(form);
    EXPECT_GE(most, 1);
    EXPECT_LE(most, 3) << name;
    EXPECT_LE(momentum, 1e-11) << name;
    if (form == FilterProjection::shake) {
      EXPECT_LE(angular, 1e-9);
    }
    test::verify("paper constraints: wedge stack, " + name + ", most iterations to 1e-6 in 2000 steps",
                 "at most 3", most, "");
    test::verify("paper constraints: wedge stack, " + name + ", change of momentum in 2000 steps, relative",
                 "0", momentum, "1e-11");
    test::verify(
        "paper constraints: wedge stack, " + name + ", change of angular momentum in 2000 steps, relative",
        form == FilterProjection::shake ? "0" : "reported", angular,
        form == FilterProjection::shake ? "1e-9" : "");
  }
}

/// So fast that lengths are off by more than 1e-6 after a single sweep; which keeps momenta all the same.
TEST(WedgeStack, IsProjectedByAsManySweepsAsAskedFor) {
  const auto path = test::shared_mesh("wedge_stack.msh");
  if (!path) GTEST_SKIP() << "wedge_stack.msh is not in EVERT_SHARED_MESHES";
  if (size_of(PETSC_COMM_WORLD) > 1) GTEST_SKIP() << "one rank shows it";
  constexpr double fast = 30;
  constexpr int steps = 500;
  for (const int sweeps : {1, 0}) {
    const auto body = moving_stack(*path, FilterProjection::shake, PETSC_COMM_WORLD, fast, sweeps);
    const auto before = body->measure();
    int most = 0;
    double left = 0;
    for (int step = 0; step < steps; ++step) {
      most = std::max(most, body->step(stack_step).projection_iterations);
      left = std::max(left, largest_violation(body->filter()->shape_constraints(), body->positions()));
    }
    const auto after = body->measure();
    EXPECT_LE(norm(after.momentum - before.momentum), 1e-11 * norm(before.momentum));
    EXPECT_LE(norm(after.angular_momentum - before.angular_momentum), 1e-9 * norm(before.angular_momentum));
    const std::string name = sweeps == 1
                                 ? "paper constraints: wedge stack at 30 times the speed, a single sweep"
                                 : "paper constraints: wedge stack at 30 times the speed";
    test::verify(name + ", largest strain of a length that is kept, in 500 steps",
                 sweeps == 1 ? "above 1e-6, below 1e-2" : "0", left, sweeps == 1 ? "" : "1e-6");
    if (sweeps == 1) {
      EXPECT_EQ(most, 1);
      EXPECT_GT(left, 1e-6);
      EXPECT_LT(left, 1e-2);
    } else {
      EXPECT_GT(most, 1);
      EXPECT_LE(left, 1e-6);
    }
  }
}

/// The class rule keeps six of these only: steps of the symplectic Euler scheme with all of them, so fast
/// that a step strains edges by most of a percent.
TEST(WedgeStack, IsProjectedInThreeIterationsWithAllEdges) {
  const auto path = test::shared_mesh("wedge_stack.msh");
  if (!path) GTEST_SKIP() << "wedge_stack.msh is not in EVERT_SHARED_MESHES";
  if (size_of(PETSC_COMM_WORLD) > 1) GTEST_SKIP() << "the edges are of one rank";
  constexpr double fast = 100;
  for (const auto form : {FilterProjection::shake, FilterProjection::goldenthal}) {
    Constrained stack(*path, 0.05, stack_step, form);
    const auto& mesh = stack.mesh;
    const auto edges = all_edges(stack);
    ShapeProjection projection(mesh, stack.elastic, edges, form);
    ASSERT_EQ(projection.rows().size(), 21U);
    auto x = stack.at_rest();
    NodeField v(mesh), f(mesh);
    for (LocalIndex i = 0; i < mesh.owned_nodes; ++i)
      set_node_value(v.owned(), i, fast * initial_velocity(mesh.rest_positions[static_cast<std::size_t>(i)]));
    int most = 0;
    double strained = 0, left = 0;
    for (int step = 0; step < 2000; ++step) {
      projection.begin(x, {});
      stack.elastic.update(x, f);
      for (std::size_t i = 0; i < v.owned().size(); ++i) {
        v.owned()[i] += stack_step / stack.elastic.masses()[i / 3] * f.owned()[i];
        x.owned()[i] += stack_step * v.owned()[i];
      }
      x.touched();
      strained = std::max(strained, largest_violation(edges, x));
      most = std::max(most, projection.project(x, v, {}, stack_step));
      left = std::max(left, largest_violation(edges, x));
    }
    const std::string name = form_name(form);
    EXPECT_GE(strained, 5e-3) << name;
    EXPECT_LE(left, 1e-6) << name;
    EXPECT_GE(most, 2) << name;
    EXPECT_LE(most, 3) << name;
    const std::string all = "paper constraints: wedge stack, all 21 edges, " + name;
    test::verify(all + ", most iterations to 1e-6 in 2000 steps", "at most 3", most, "");
    test::verify(all + ", largest strain of an edge before the projection", "reported", strained, "");
  }
}

TEST(WedgeStack, DoesNotDependOnTheNumberOfRanks) {
  const auto path = test::shared_mesh("wedge_stack.msh");
  if (!path) GTEST_SKIP() << "wedge_stack.msh is not in EVERT_SHARED_MESHES";
  if (size_of(PETSC_COMM_WORLD) == 1) GTEST_SKIP() << "one rank";
  const auto shared = moving_stack(*path, FilterProjection::shake);
  EXPECT_GT(shared->projection()->rows().spanning_rows(), 0) << "clusters must span ranks";
  const auto whole = moving_stack(*path, FilterProjection::shake, PETSC_COMM_SELF);
  const double difference =
      test::largest_difference(test::after_steps(*shared, 200), test::after_steps(*whole, 200));
  EXPECT_LE(difference, 1e-9);
  test::verify("paper constraints: wedge stack after 200 steps on one rank and on several [m]", "the same",
               difference, "1e-9");
}

/// A quarter of its lengths depends on the others: they are met with them.
TEST(CutCube, IsProjectedWithDependentLengths) {
  const auto path = test::shared_mesh("cut_cube.msh");
  if (!path) GTEST_SKIP() << "cut_cube.msh is not in EVERT_SHARED_MESHES";
  if (size_of(PETSC_COMM_WORLD) > 1) GTEST_SKIP() << "looks at the whole of J";
  Constrained cube(*path, 0.06, 0.9e-3, FilterProjection::shake);
  const auto independent = rank_of_rows(cube, cube.filter.shape_constraints());
  EXPECT_LT(independent, 0.8 * static_cast<double>(cube.constraints()));
  auto x = cube.at_rest();
  NodeField v(cube.mesh);
  cube.projection.begin(x, {});
  for (LocalIndex i = 0; i < cube.mesh.owned_nodes; ++i) {
    const Vec3d p = cube.mesh.rest_positions[static_cast<std::size_t>(i)];
    set_node_value(x.owned(), i, p + 1e-4 * wave(p));
  }
  x.touched();
  EXPECT_GT(cube.largest_violation(x), 1e-4);
  const int iterations = cube.projection.project(x, v, {}, 1e-3);
  EXPECT_LE(iterations, 3);
  EXPECT_LE(cube.largest_violation(x), 1e-6);
  test::verify("paper constraints: cut cube, lengths", "some depend on others",
               static_cast<double>(cube.constraints()), "");
  test::verify("paper constraints: cut cube, rank of these", "fewer", static_cast<double>(independent), "");
  test::verify("paper constraints: cut cube, iterations to 1e-6", "at most 3", iterations, "");
}

/// Owned nodes of one half, held in all directions.
std::vector<NodeConstraint> held_half(const DistributedMesh& mesh) {
  std::vector<NodeConstraint> held;
  for (LocalIndex i = 0; i < mesh.owned_nodes; ++i)
    if (mesh.rest_positions[static_cast<std::size_t>(i)][0] < 0) held.push_back({i, {}, {}});
  return held;
}

/// Over all ranks, constraints with a node in the other half.
GlobalIndex constraints_that_move(const Constrained& body) {
  auto count = static_cast<GlobalIndex>(
      std::ranges::count_if(body.filter.shape_constraints(), [&](const ShapeConstraint& constraint) {
        return std::ranges::any_of(constraint.nodes, [&](LocalIndex node) {
          return node >= 0 && !(body.mesh.rest_positions[static_cast<std::size_t>(node)][0] < 0);
        });
      }));
  MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, body.mesh.comm);
  return count;
}

GlobalIndex rows_of(const Constrained& body) {
  auto count = static_cast<GlobalIndex>(body.projection.rows().size());
  MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, body.mesh.comm);
  return count;
}

/// Lengths between held nodes are not solved for, and what is left is met as with them.
TEST(Ball, SolvesForNoLengthsBetweenHeldNodes) {
  const auto path = test::shared_mesh("ball404.msh");
  if (!path) GTEST_SKIP() << "ball404.msh is not in EVERT_SHARED_MESHES";
  for (const auto form : {FilterProjection::shake, FilterProjection::goldenthal}) {
    Constrained ball(*path, 1000, 7.5e-3, form);
    const auto held = held_half(ball.mesh);
    const auto rest = ball.at_rest();
    const auto projected = [&](std::span<const NodeConstraint> prescribed) {
      auto x = ball.at_rest();
      NodeField v(ball.mesh);
      ball.projection.begin(x, prescribed);
      for (LocalIndex i = 0; i < ball.mesh.owned_nodes; ++i) {
        const Vec3d p = ball.mesh.rest_positions[static_cast<std::size_t>(i)];
        if (!(p[0] < 0)) set_node_value(x.owned(), i, p + 1e-3 * wave(p));
      }
      x.touched();
      EXPECT_GT(ball.largest_violation(x), 1e-4);
      ball.projection.project(x, v, held, 1e-3);
      EXPECT_LE(ball.largest_violation(x), 1e-6);
      for (const auto& constraint : held)
        EXPECT_EQ(norm(node_value(x.owned(), constraint.node) - node_value(rest.owned(), constraint.node)),
                  0);
      return test::gathered(ball.mesh, x);
    };
    EXPECT_EQ(rows_of(ball), ball.constraints());
    const auto without = projected(held);
    EXPECT_EQ(rows_of(ball), constraints_that_move(ball));
    EXPECT_GT(rows_of(ball), 0);
    EXPECT_LT(rows_of(ball), ball.constraints());
    test::verify("paper constraints: ball of 404 tetrahedra, half of it held, lengths solved for of " +
                     std::to_string(ball.constraints()) + ", " + form_name(form),
                 std::to_string(constraints_that_move(ball)), static_cast<double>(rows_of(ball)), "0");
    const auto with = projected({});  // held only later, as by collisions
    EXPECT_EQ(rows_of(ball), ball.constraints());
    EXPECT_LE(test::largest_difference(without, with), 1e-9);
  }
}

TEST(Ball, NamesHeldNodesThatContradictLengths) {
  const auto path = test::shared_mesh("ball404.msh");
  if (!path) GTEST_SKIP() << "ball404.msh is not in EVERT_SHARED_MESHES";
  Constrained ball(*path, 1000, 7.5e-3, FilterProjection::shake);
  const auto held = held_half(ball.mesh);
  auto x = ball.at_rest();
  NodeField v(ball.mesh);
  ball.projection.begin(x, held);
  for (double& coordinate : x.owned()) coordinate *= 1.01;
  x.touched();
  EXPECT_THROW(ball.projection.project(x, v, held, 1e-3), UserError);
}

/// Most elements of the ball are filtered: 20,000 lengths, of which fewer than half are independent.
TEST(Ball, IsProjectedWithTwentyThousandConstraints) {
  const auto path = test::shared_mesh("ball20k.msh");
  if (!path) GTEST_SKIP() << "ball20k.msh is not in EVERT_SHARED_MESHES";
  if (size_of(PETSC_COMM_WORLD) == 1) GTEST_SKIP() << "across ranks";
  Constrained ball(*path, 1000, 0.02, FilterProjection::shake);
  EXPECT_GE(ball.constraints(), 20000);
  auto x = ball.at_rest();
  NodeField v(ball.mesh);
  ball.projection.begin(x, {});
  for (LocalIndex i = 0; i < ball.mesh.owned_nodes; ++i) {
    const Vec3d p = ball.mesh.rest_positions[static_cast<std::size_t>(i)];
    set_node_value(x.owned(), i, p + 1e-4 * wave(p));
  }
  x.touched();
  EXPECT_GT(ball.largest_violation(x), 1e-5);
  const int iterations = ball.projection.project(x, v, {}, 1e-3);
  EXPECT_LE(ball.largest_violation(x), 1e-6);
  test::verify("paper constraints: ball of 19,964 tetrahedra, constraints", "at least 20000",
               static_cast<double>(ball.constraints()), "");
  test::verify("paper constraints: the same, iterations to 1e-6 on several ranks", "few", iterations, "");
}

}  // namespace
}  // namespace evert
