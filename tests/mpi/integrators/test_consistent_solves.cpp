// Velocity solves with consistent masses.
#include "evert/integrators/damping_solver.hpp"
#include "evert/math/nodal.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/quadratic.hpp"

#include <gtest/gtest.h>

#include "deformed_box.hpp"
#include "tests/support/petsc_options.hpp"
#include <cmath>
#include <string>

namespace evert {
namespace {

Mesh quadratic_box() {
  Mesh mesh = generate_box({{1, 0.5, 0.5}}, {2, 1, 1}, BoxCells::tet6);
  make_quadratic(mesh);
  return mesh;
}

/// A deformed box with consistent masses: damped by strain and by velocity, or not at all.
class ConsistentBox : public testing::TestWithParam<bool> {
 protected:
  ConsistentBox() {
    test::deform(mesh_, 0.2, x_, v_);
    elastic_.update(x_, f_);
    check(VecDuplicate(v_.vec(), right_.out()));
    check(VecCopy(v_.vec(), right_.get()));
    check(VecScale(right_.get(), 3.0));
  }

  [[nodiscard]] std::vector<ElasticProperties> properties() const {
    const Lame lame = Lame::from_young_poisson(1e4, 0.4);
    if (!GetParam()) return {{1000, NeoHookean{lame}, {}}};
    ElasticProperties damped{
        1000, NeoHookean{lame},
        Damping::stiffness_proportional(DampingModel::rotated, 0.05, lame.lambda, lame.mu)};
    damped.mass_proportional_damping = 40;
    return {damped};
  }

  [[nodiscard]] std::vector<NodeConstraint> constraints() const { return test::some_constraints(mesh_); }

  /// ‖a − b‖ in the largest component; b becomes the difference.
  static double difference(Vec a, Vec b) {
    PetscReal norm = 0;
    check(VecAXPY(b, -1.0, a));
    check(VecNorm(b, NORM_INFINITY, &norm));
    return norm;
  }

  /// ‖P (b − (M + s C) v)‖, from the parts of the operator.
  double residual_norm(double s, std::span<const NodeConstraint> held) {
    NodeField momentum(mesh_), damping(mesh_);
    elastic_.add_momentum(v_, momentum);
    elastic_.add_damping(v_, damping, s);
    const PetscScalar* right = nullptr;
    check(VecGetArrayRead(right_.get(), &right));
    for (std::size_t i = 0; i < momentum.owned().size(); ++i)
      momentum.owned()[i] = right[i] - momentum.owned()[i] - damping.owned()[i];
    check(VecRestoreArrayRead(right_.get(), &right));
    project(held, momentum.owned());
    momentum.touched();
    PetscReal norm = 0;
    check(VecNorm(momentum.vec(), NORM_2, &norm));
    return norm;
  }

  DistributedMesh mesh_ = distribute(PETSC_COMM_WORLD, quadratic_box());
  ElasticForces elastic_{mesh_, properties(), MassForm::consistent};
  NodeField x_{mesh_}, v_{mesh_}, f_{mesh_};
  VecHandle right_;
};

TEST_P(ConsistentBox, ShellAndMatrixAreOneOperator) {
  DampingOperator shell(mesh_, elastic_);
  const auto held = constraints();
  shell.set(0.01, held);
  for (const char* type : {MATAIJ, MATBAIJ, MATSBAIJ}) {
    AssembledDamping assembled(shell, type);
    assembled.assemble();
    VecHandle expected, found;
    check(VecDuplicate(right_.get(), expected.out()));
    check(VecDuplicate(right_.get(), found.out()));
    check(MatMult(shell.mat(), right_.get(), expected.get()));
    check(MatMult(assembled.mat(), right_.get(), found.get()));
    PetscReal scale = 0;
    check(VecNorm(expected.get(), NORM_INFINITY, &scale));
    EXPECT_LE(difference(expected.get(), found.get()), 1e-13 * scale) << type;
    check(MatGetDiagonal(shell.mat(), expected.get()));
    check(MatGetDiagonal(assembled.mat(), found.get()));
    EXPECT_LE(difference(expected.get(), found.get()), 1e-13 * scale) << type;
  }
}

TEST_P(ConsistentBox, SolvesWithTheConstraintsHeldExactly) {
  const test::Options tolerance{{"-damping_ksp_rtol", "1e-12"}};
  const auto held = constraints();
  const double s = 0.01;
  for (const auto& [mat, pc] : {std::pair{"shell", "pbjacobi"},
                                {"shell", "jacobi"},
                                {"aij", "bjacobi"},
                                {"baij", "pbjacobi"},
                                {"sbaij", "jacobi"}}) {
    const test::Options mat_type{{"-damping_mat_type", mat}};
    const test::Options pc_type{{"-damping_pc_type", pc}};
    DampingSolver solver(mesh_, elastic_);
    ASSERT_TRUE(solver.iterates());
    for (auto& value : v_.owned()) value = 1;
    v_.touched();
    EXPECT_GT(solver.solve(s, right_.get(), v_, held), 0) << mat;
    PetscReal before = 0;
    check(VecNorm(right_.get(), NORM_2, &before));
    EXPECT_LE(residual_norm(s, held), 1e-10 * before) << mat << " " << pc;
    for (const auto& c : held) {
      const auto v = node_value(v_.owned(), c.node);
      EXPECT_LE(norm(v - c.free * v - c.prescribed), 1e-12);
    }
    solver.solve(s, right_.get(), v_, {});
    EXPECT_LE(residual_norm(s, {}), 1e-10 * before) << mat << " " << pc;
  }
}

/// M is well conditioned in every cell, whatever the size of the cells.
TEST_P(ConsistentBox, TakesFewIterationsWithoutDamping) {
  if (GetParam()) GTEST_SKIP() << "damping makes the solve harder";
  DampingSolver solver(mesh_, elastic_);
  const int iterations = solver.solve(0.01, right_.get(), v_, {});
  EXPECT_GT(iterations, 5);
  EXPECT_LT(iterations, 40);
}

INSTANTIATE_TEST_SUITE_P(Damped, ConsistentBox, testing::Bool(),
                         [](const auto& damped) { return damped.param ? "yes" : "no"; });

}  // namespace
}  // namespace evert
