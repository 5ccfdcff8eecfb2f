#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/integrators/damping_solver.hpp"
#include "evert/math/nodal.hpp"
#include "evert/mesh/generators.hpp"

#include <gtest/gtest.h>

#include "deformed_box.hpp"
#include "tests/support/petsc_options.hpp"
#include "tests/support/verify.hpp"
#include <cmath>
#include <memory>
#include <random>
#include <string>

namespace evert {
namespace {

/// A deformed, damped box and a velocity; the same for any number of ranks.
class DampedBox : public testing::Test {
 protected:
  DampedBox() {
    test::deform(mesh_, 0.3, x_, v_);
    elastic_.update(x_, f_);
    check(VecDuplicate(v_.vec(), right_.out()));
    check(VecCopy(v_.vec(), right_.get()));
    check(VecScale(right_.get(), 3.0));
  }

  [[nodiscard]] std::vector<NodeConstraint> constraints() const { return test::some_constraints(mesh_); }

  /// ‖P (b − (M + s C) v)‖ over all ranks.
  double residual_norm(DampingSolver& solver, double s, std::span<const NodeConstraint> held) {
    VecHandle left;
    check(VecDuplicate(right_.get(), left.out()));
    check(VecCopy(right_.get(), left.get()));
    PetscScalar* values = nullptr;
    check(VecGetArray(left.get(), &values));
    const auto size = v_.owned().size();
    for (std::size_t i = 0; i < size; ++i) values[i] -= elastic_.masses()[i / 3] * v_.owned()[i];
    check(VecRestoreArray(left.get(), &values));
    solver.add_damping(v_.vec(), left.get(), -s);
    check(VecGetArray(left.get(), &values));
    project(held, {values, size});
    check(VecRestoreArray(left.get(), &values));
    PetscReal norm = 0;
    check(VecNorm(left.get(), NORM_2, &norm));
    return norm;
  }

  DistributedMesh mesh_ =
      distribute(PETSC_COMM_WORLD, generate_box({{1, 0.5, 0.5}}, {4, 2, 2}, BoxCells::tet6));
  Lame lame_ = Lame::from_young_poisson(1e4, 0.4);
  std::vector<ElasticProperties> properties_{
      {1000, NeoHookean{lame_},
       Damping::stiffness_proportional(DampingModel::rotated, 0.05, lame_.lambda, lame_.mu)}};
  ElasticForces elastic_{mesh_, properties_};
  NodeField x_{mesh_}, v_{mesh_}, f_{mesh_};
  VecHandle right_;
};

struct Choice {
  const char* mat_type;
  const char* pc_type;
};

class EveryOperator : public DampedBox, public testing::WithParamInterface<Choice> {};

TEST_P(EveryOperator, SolvesWithTheConstraintsHeldExactly) {
  const test::Options mat{{"-damping_mat_type", GetParam().mat_type}};
  const test::Options pc{{"-damping_pc_type", GetParam().pc_type}};
  const test::Options tolerance{{"-damping_ksp_rtol", "1e-11"}};
  DampingSolver solver(mesh_, elastic_);
  const auto held = constraints();
  const double s = 0.01;
  const double before = [&] {
    PetscReal norm = 0;
    check(VecNorm(right_.get(), NORM_2, &norm));
    return norm;
  }();
  const int iterations = solver.solve(s, right_.get(), v_, held);
  EXPECT_GT(iterations, 0);
  EXPECT_LE(residual_norm(solver, s, held), 1e-9 * before);
  for (const auto& c : held) {
    const auto v = node_value(v_.owned(), c.node);
    EXPECT_LE(norm(v - c.free * v - c.prescribed), 1e-12);
  }
}

TEST_P(EveryOperator, ConstraintsHardlyCostIterations) {
  const test::Options mat{{"-damping_mat_type", GetParam().mat_type}};
  const test::Options pc{{"-damping_pc_type", GetParam().pc_type}};
  DampingSolver free(mesh_, elastic_), constrained(mesh_, elastic_);
  NodeField v(mesh_);
  const int without = free.solve(0.01, right_.get(), v, {});
  const int with = constrained.solve(0.01, right_.get(), v_, constraints());
  const double ratio = static_cast<double>(with) / without;
  test::verify(std::string("CG iterations with constraints over those without, ") + GetParam().mat_type +
                   ", " + GetParam().pc_type,
               "<= 1.3", ratio, "-");
  EXPECT_GE(without, 4) << "else the comparison says nothing";
  EXPECT_LE(ratio, 1.3);
}

TEST_P(EveryOperator, SolvesAgainAfterTheMaterialMoved) {
  const test::Options mat{{"-damping_mat_type", GetParam().mat_type}};
  const test::Options pc{{"-damping_pc_type", GetParam().pc_type}};
  const test::Options tolerance{{"-damping_ksp_rtol", "1e-11"}};
  DampingSolver solver(mesh_, elastic_);
  solver.solve(0.01, right_.get(), v_, {});
  for (auto& value : x_.owned()) value *= 1.3;
  x_.touched();
  elastic_.update(x_, f_);
  solver.invalidate();
  solver.solve(0.02, right_.get(), v_, {});
  EXPECT_LE(residual_norm(solver, 0.02, {}), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(
    All, EveryOperator,
    testing::Values(Choice{"shell", "pbjacobi"}, Choice{"shell", "jacobi"}, Choice{"shell", "none"},
                    Choice{"baij", "pbjacobi"}, Choice{"baij", "bjacobi"}, Choice{"aij", "gamg"},
                    Choice{"sbaij", "jacobi"}, Choice{"sbaij", "bjacobi"}, Choice{"aij", "bjacobi"}),
    [](const auto& choice) { return std::string(choice.param.mat_type) + "_" + choice.param.pc_type; });

/// The same with damping proportional to mass besides.
class DraggedBox : public DampedBox {
 protected:
  DraggedBox() {
    properties_.front().mass_proportional_damping = 40;
    both_ = std::make_unique<ElasticForces>(mesh_, properties_);
    both_->update(x_, f_);
  }
  std::unique_ptr<ElasticForces> both_;
};

TEST_F(DraggedBox, DampsEveryVelocityInProportionToItsMass) {
  NodeField viscous(mesh_), all(mesh_);
  elastic_.add_damping(v_, viscous, 0.5);
  both_->add_damping(v_, all, 0.5);
  for (std::size_t i = 0; i < all.owned().size(); ++i) {
    const double expected = viscous.owned()[i] + 0.5 * 40 * elastic_.masses()[i / 3] * v_.owned()[i];
    EXPECT_NEAR(all.owned()[i], expected, 1e-14 * (1 + std::abs(expected))) << i;
  }
}

TEST_F(DraggedBox, ShellAndMatrixAreOneOperator) {
  DampingOperator shell(mesh_, *both_);
  const auto held = constraints();
  shell.set(0.01, held);
  for (const char* type : {MATAIJ, MATBAIJ, MATSBAIJ}) {
    AssembledDamping assembled(shell, type);
    assembled.assemble();
    VecHandle expected, found;
    check(VecDuplicate(right_.get(), expected.out()));
    check(VecDuplicate(right_.get(), found.out()));
    PetscReal scale = 0, error = 0;
    check(MatMult(shell.mat(), right_.get(), expected.get()));
    check(MatMult(assembled.mat(), right_.get(), found.get()));
    check(VecNorm(expected.get(), NORM_INFINITY, &scale));
    check(VecAXPY(found.get(), -1.0, expected.get()));
    check(VecNorm(found.get(), NORM_INFINITY, &error));
    EXPECT_LE(error, 1e-13 * scale) << type;
    check(MatGetDiagonal(shell.mat(), expected.get()));
    check(MatGetDiagonal(assembled.mat(), found.get()));
    check(VecAXPY(found.get(), -1.0, expected.get()));
    check(VecNorm(found.get(), NORM_INFINITY, &error));
    EXPECT_LE(error, 1e-13 * scale) << type;
  }
}

TEST_F(DraggedBox, AloneItIsOneIterationAndFollowsAnEvent) {
  properties_.front().damping = {};
  ElasticForces dragged(mesh_, properties_);
  dragged.update(x_, f_);
  ASSERT_TRUE(dragged.damped());
  DampingSolver solver(mesh_, dragged);
  EXPECT_EQ(solver.solve(0.01, right_.get(), v_, {}), 1);  // its diagonal is all of it
  EXPECT_LE(residual_norm(solver, 0.01, {}), 1e-12);
  properties_.front().mass_proportional_damping = 0;
  dragged.set_properties(0, properties_.front());
  for (const double damping : dragged.mass_damping()) EXPECT_EQ(damping, 0);
}

TEST_F(DampedBox, DiagonalOfTheShellIsThatOfTheMatrix) {
  DampingOperator shell(mesh_, elastic_);
  const auto held = constraints();
  shell.set(0.01, held);
  AssembledDamping assembled(shell, MATAIJ);
  assembled.assemble();
  VecHandle difference, expected;
  check(VecDuplicate(right_.get(), difference.out()));
  check(VecDuplicate(right_.get(), expected.out()));
  check(MatGetDiagonal(shell.mat(), difference.get()));
  check(MatGetDiagonal(assembled.mat(), expected.get()));
  check(VecAXPY(difference.get(), -1.0, expected.get()));
  check(VecPointwiseDivide(difference.get(), difference.get(), expected.get()));
  PetscReal largest = 0;
  check(VecNorm(difference.get(), NORM_INFINITY, &largest));
  EXPECT_LE(largest, 1e-13);  // sums of some ten cells' entries, all positive
}

TEST_F(DampedBox, ReactionIsWhatTheConstraintsExert) {
  const test::Options tolerance{{"-damping_ksp_rtol", "1e-13"}};
  DampingSolver solver(mesh_, elastic_);
  const auto held = constraints();
  solver.solve(0.01, right_.get(), v_, held);
  const auto reaction = solver.reaction();
  // Σ reactions = Σ (M v − b), since C takes nothing from the momentum.
  Vec3d exerted{}, missing{};
  for (const auto& c : held) {
    const auto r = node_value(reaction, c.node);
    exerted += r - c.free * r;
  }
  const PetscScalar* right = nullptr;
  check(VecGetArrayRead(right_.get(), &right));
  for (std::size_t i = 0; i < v_.owned().size(); ++i)
    missing[i % 3] += elastic_.masses()[i / 3] * v_.owned()[i] - right[i];
  check(VecRestoreArrayRead(right_.get(), &right));
  MPI_Allreduce(MPI_IN_PLACE, exerted.components.data(), 3, MPI_DOUBLE, MPI_SUM, mesh_.comm);
  MPI_Allreduce(MPI_IN_PLACE, missing.components.data(), 3, MPI_DOUBLE, MPI_SUM, mesh_.comm);
  EXPECT_GT(norm(exerted), 0.1);
  EXPECT_LE(norm(exerted - missing), 1e-9 * norm(exerted));
}

TEST_F(DampedBox, RefiningIsSolvingAgain) {
  const test::Options tolerance{{"-damping_ksp_rtol", "1e-13"}};
  DampingSolver solver(mesh_, elastic_);
  const auto held = constraints();
  solver.solve(0.01, right_.get(), v_, {});
  // An impulse on every second node, and nodes held that were free: refined, and solved from nothing.
  const auto reaction = solver.reaction();
  {
    PetscScalar* right = nullptr;
    check(VecGetArray(right_.get(), &right));
    for (std::size_t i = 0; i < reaction.size(); i += 6) {
      reaction[i] -= 0.5;
      right[i] += 0.5;
    }
    check(VecRestoreArray(right_.get(), &right));
  }
  NodeField expected(mesh_);
  std::copy(v_.owned().begin(), v_.owned().end(), expected.owned().begin());
  expected.touched();
  solver.refine(v_, held);
  const std::vector<double> refined_reaction(solver.reaction().begin(), solver.reaction().end());
  DampingSolver from_nothing(mesh_, elastic_);
  from_nothing.solve(0.01, right_.get(), expected, held);
  const auto expected_reaction = from_nothing.reaction();
  for (std::size_t i = 0; i < v_.owned().size(); ++i) {
    EXPECT_NEAR(v_.owned()[i], expected.owned()[i], 1e-10);
    EXPECT_NEAR(refined_reaction[i], expected_reaction[i], 1e-9);
  }
}

TEST_F(DampedBox, WithoutDampingTheSolveIsADivision) {
  properties_.front().damping = {};
  ElasticForces undamped(mesh_, properties_);
  DampingSolver solver(mesh_, undamped);
  EXPECT_FALSE(solver.iterates());
  EXPECT_EQ(solver.solve(0.1, right_.get(), v_, {}), 0);
  const PetscScalar* right = nullptr;
  check(VecGetArrayRead(right_.get(), &right));
  for (std::size_t i = 0; i < v_.owned().size(); ++i)
    EXPECT_NEAR(v_.owned()[i], right[i] / undamped.masses()[i / 3], 1e-13 * std::abs(v_.owned()[i]) + 1e-13);
  check(VecRestoreArrayRead(right_.get(), &right));
}

TEST_F(DampedBox, OptionsThatCannotWorkAreUserErrors) {
  {
    const test::Options mat{{"-damping_mat_type", "bajj"}};
    EXPECT_THROW(DampingSolver(mesh_, elastic_), UserError);
  }
  const test::Options pc{{"-damping_pc_type", "gamg"}};
  EXPECT_THROW(DampingSolver(mesh_, elastic_), UserError);
}

}  // namespace
}  // namespace evert
