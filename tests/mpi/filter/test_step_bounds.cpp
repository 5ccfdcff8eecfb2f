// Bounds of the largest eigenvalue of M⁻¹K against the dense eigenproblem, on any number of ranks.
#include "evert/mesh/generators.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "all_bounds.hpp"
#include <cmath>
#include <random>

namespace evert::test {
namespace {

/// A box whose nodes are shaken, and one of them pushed down until some of its cells are nearly flat.
Mesh box_with_flat_cells() {
  Mesh mesh = generate_box({{1, 0.75, 0.75}}, {4, 3, 3}, BoxCells::tet6);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> shift(-0.02, 0.02);
  for (auto& node : mesh.nodes) node += Vec3d{shift(random), shift(random), shift(random)};
  const auto& tets = *mesh.block(CellType::tet4);
  const auto corner = [&](std::size_t k) -> Vec3d& {
    return mesh.nodes[static_cast<std::size_t>(tets.nodes[4 * (tets.nodes.size() / 8) + k])];
  };
  const Vec3d middle = (1.0 / 3) * (corner(0) + corner(1) + corner(2));
  corner(3) = middle + 0.01 * (corner(3) - middle);
  return mesh;
}

constexpr Lame lame = Lame::from_young_poisson(1e4, 0.3);

struct Body {
  std::string name;
  Mesh mesh;
  Material material;
};

std::vector<Body> bodies() {
  return {
      {"flat_cells", box_with_flat_cells(), RotatedLinear{.lame = lame}},
      {"hexahedra", generate_box({{1, 0.5, 0.5}}, {4, 2, 2}, BoxCells::hex8), NeoHookean{.lame = lame}},
      {"wedges", generate_box({{1, 0.5, 0.5}}, {4, 2, 2}, BoxCells::wedge6), RotatedLinear{.lame = lame}}};
}

Vec3d bent(const Vec3d& rest) {
  return {0.7 * rest[0] + 0.1 * rest[1], rest[1] + 0.2 * rest[0] * rest[0], 1.1 * rest[2] - 0.1 * rest[1]};
}

double dense_truth(const DistributedMesh& mesh, const ElasticForces& elastic, NodeField& x) {
  MassScaledStiffness stiffness(mesh, elastic);
  stiffness.assemble(x);
  const PetscInt size = 3 * mesh.owned_nodes;
  Eigen::MatrixXd dense(size, size);
  for (PetscInt i = 0; i < size; ++i)
    for (PetscInt j = 0; j < size; ++j) check(MatGetValues(stiffness.mat(), 1, &i, 1, &j, &dense(i, j)));
  EXPECT_LE((dense - dense.transpose()).norm(), 1e-12 * dense.norm());
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

class Bounds : public testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static ElasticProperties properties(const Body& body) { return {1000, body.material, {}}; }

  void hold(Vec3d (*map)(const Vec3d&)) {
    const Body body = bodies()[GetParam()];
    auto alone = distribute(PETSC_COMM_SELF, body.mesh);
    ElasticForces elastic_alone(alone, std::vector{properties(body)});
    auto x_alone = placed(alone, map);
    const double truth = dense_truth(alone, elastic_alone, x_alone);
    const auto one = all_bounds(alone, elastic_alone, x_alone);

    auto mesh = distribute(PETSC_COMM_WORLD, body.mesh);
    ElasticForces elastic(mesh, std::vector{properties(body)});
    auto x = placed(mesh, map);
    const auto found = all_bounds(mesh, elastic, x);
    // The tolerance of SLEPc is of the residual; the eigenvalue is closer still.
    EXPECT_NEAR(found.truth, truth, 1e-9 * truth);
    EXPECT_LE(found.eq8_lower, truth * (1 + 1e-12));
    EXPECT_GE(found.eq9, truth * (1 - 1e-12));
    EXPECT_GE(found.eq8_upper, truth * (1 - 1e-12));
    EXPECT_GE(found.collatz_wielandt, truth * (1 - 1e-12));
    EXPECT_LE(found.lanczos, truth * (1 + 1e-12));
    EXPECT_GE(found.lanczos, 0.98 * truth);
    EXPECT_NEAR(found.eq9, one.eq9, 1e-12 * truth);
    EXPECT_NEAR(found.eq8_upper, one.eq8_upper, 1e-10 * truth);
    EXPECT_NEAR(found.collatz_wielandt, one.collatz_wielandt, 1e-10 * truth);
    EXPECT_NEAR(found.lanczos, one.lanczos, 1e-6 * truth);  // Lanczos magnifies rounding
  }
};

TEST_P(Bounds, HoldAtRest) {
  hold([](const Vec3d& rest) { return rest; });
}

TEST_P(Bounds, HoldInADeformedState) { hold(bent); }

TEST_P(Bounds, CollatzWielandtIsABoundAfterEveryIteration) {
  const Body body = bodies()[GetParam()];
  auto mesh = distribute(PETSC_COMM_WORLD, body.mesh);
  ElasticForces elastic(mesh, std::vector{properties(body)});
  auto x = at_rest(mesh);
  MassScaledStiffness stiffness(mesh, elastic);
  stiffness.assemble(x);
  const double truth = fastest_mode(stiffness).squared_frequency;
  double before = std::numeric_limits<double>::infinity();
  for (int iterations = 1; iterations <= 20; ++iterations) {
    const double bound = collatz_wielandt_bound(stiffness.mat(), iterations);
    EXPECT_GE(bound, truth * (1 - 1e-12));
    EXPECT_LE(bound, before);
    before = bound;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Bounds, testing::Values(0U, 1U, 2U),
                         [](const auto& test) { return bodies()[test.param].name; });

TEST(Bounds, OfNoStiffnessAreZeroAndLimitNoStep) {
  auto mesh = distribute(PETSC_COMM_WORLD, box_with_flat_cells());
  ElasticForces elastic(mesh, std::vector{ElasticProperties{1000, RotatedLinear{.lame = {0, 0}}, {}}});
  auto x = at_rest(mesh);
  const auto found = all_bounds(mesh, elastic, x);
  for (const double bound :
       {found.truth, found.eq9, found.eq8_upper, found.collatz_wielandt, found.lanczos}) {
    EXPECT_EQ(bound, 0);
    EXPECT_TRUE(std::isinf(step_limit(bound)));
  }
}

TEST(Bounds, OfABodyInTwoPartsAreThoseOfTheFaster) {
  // The Perron vector of the slower part shrinks beside that of the other, and must stay positive.
  Mesh mesh = box_with_flat_cells();
  const auto first = static_cast<GlobalIndex>(mesh.nodes.size());
  const Mesh other = generate_box({{50, 50, 50}}, {2, 2, 2}, BoxCells::tet6);
  for (const auto& node : other.nodes) mesh.nodes.push_back(node + Vec3d{10, 0, 0});
  for (const auto node : other.cells[0].nodes) mesh.cells[0].nodes.push_back(node + first);
  mesh.cells[0].region.resize(mesh.cells[0].region.size() + other.cells[0].region.size());
  const std::vector properties{ElasticProperties{1000, RotatedLinear{.lame = lame}, {}}};
  const auto bounds_of = [&](const Mesh& whole) {
    auto distributed = distribute(PETSC_COMM_WORLD, whole);
    ElasticForces elastic(distributed, properties);
    auto x = at_rest(distributed);
    return all_bounds(distributed, elastic, x);
  };
  const auto both = bounds_of(mesh);
  const auto one = bounds_of(box_with_flat_cells());
  EXPECT_NEAR(both.truth, one.truth, 1e-9 * one.truth);
  EXPECT_NEAR(both.collatz_wielandt, one.collatz_wielandt, 1e-10 * one.truth);
}

TEST(Bounds, OfAStateThatIsNotFiniteLeaveNoStep) {
  auto mesh = distribute(PETSC_COMM_WORLD, box_with_flat_cells());
  ElasticForces elastic(mesh, std::vector{ElasticProperties{1000, NeoHookean{.lame = lame}, {}}});
  auto x = placed(mesh, [](const Vec3d& rest) { return 1e200 * rest; });
  MassScaledStiffness stiffness(mesh, elastic);
  stiffness.assemble(x);
  EXPECT_TRUE(std::isfinite(step_limit(collatz_wielandt_bound(stiffness.mat()))));
  auto broken = placed(mesh, [](const Vec3d& rest) { return (rest[0] > 0.5 ? NAN : 1.0) * rest; });
  stiffness.assemble(broken);
  EXPECT_EQ(step_limit(collatz_wielandt_bound(stiffness.mat())), 0);
}

}  // namespace
}  // namespace evert::test
