// The bound on the stable step of a whole body with flat cells, on any number of ranks.
#include "evert/forces/elastic_forces.hpp"
#include "evert/math/nodal.hpp"
#include "evert/mesh/generators.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace evert {
namespace {

/// A box whose nodes are shaken, and one of them pushed down until some of its cells are nearly flat.
DistributedMesh box_with_flat_cells(double height) {
  Mesh mesh = generate_box({{1, 0.75, 0.75}}, {4, 3, 3}, BoxCells::tet6);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> shift(-0.02, 0.02);
  for (auto& node : mesh.nodes) node += Vec3d{shift(random), shift(random), shift(random)};
  auto& tets = *mesh.block(CellType::tet4);
  const auto corner = [&](std::size_t k) -> Vec3d& {
    return mesh.nodes[static_cast<std::size_t>(tets.nodes[4 * (tets.nodes.size() / 8) + k])];
  };
  const Vec3d middle = (1.0 / 3) * (corner(0) + corner(1) + corner(2));
  corner(3) = middle + height * (corner(3) - middle);
  return distribute(PETSC_COMM_WORLD, mesh);
}

ElasticProperties properties(double youngs_modulus, double poissons_ratio) {
  return {1000, RotatedLinear{.lame = Lame::from_young_poisson(youngs_modulus, poissons_ratio)}, {}};
}

class FlatCells : public testing::TestWithParam<double> {
 protected:
  FlatCells() {
    for (LocalIndex i = 0; i < mesh_.local_nodes(); ++i)
      set_node_value(x_.local(), i, mesh_.rest_positions[static_cast<std::size_t>(i)]);
    x_.touched();
  }

  double over_ranks(double value, MPI_Op operation) {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, operation, mesh_.comm);
    return value;
  }

  double bound() { return over_ranks(elastic_.stable_step(x_).undamped, MPI_MIN); }

  /// 2/√λmax(M⁻¹K) by power iteration, which comes from above. K u by differences of forces.
  double true_limit() {
    const double h = 1e-7;
    NodeField moved(mesh_), forward(mesh_), backward(mesh_);
    std::mt19937_64 random(static_cast<unsigned>(mesh_.first_owned) + 1);
    std::normal_distribution<double> normal;
    std::vector<double> u(x_.owned().size());
    for (double& value : u) value = normal(random);
    double lambda = 0;
    for (int iteration = 0; iteration < 300; ++iteration) {
      double length = 0;
      for (std::size_t i = 0; i < u.size(); ++i) length += elastic_.masses()[i / 3] * u[i] * u[i];
      length = std::sqrt(over_ranks(length, MPI_SUM));
      for (double& value : u) value /= length;
      const auto forces_at = [&](double step, NodeField& f) {
        for (std::size_t i = 0; i < u.size(); ++i) moved.owned()[i] = x_.owned()[i] + step * u[i];
        moved.touched();
        elastic_.update(moved, f);
      };
      forces_at(h, forward);
      forces_at(-h, backward);
      double quotient = 0;
      for (std::size_t i = 0; i < u.size(); ++i) {
        const double force = (backward.owned()[i] - forward.owned()[i]) / (2 * h);
        quotient += u[i] * force;
        u[i] = force / elastic_.masses()[i / 3];
      }
      lambda = over_ranks(quotient, MPI_SUM);
    }
    return 2 / std::sqrt(lambda);
  }

  /// The smallest step that each cell would ask for with its own mass, ρV/4 a node.
  double bound_of_own_masses() {
    double smallest = std::numeric_limits<double>::infinity();
    for (const auto& cells : mesh_.cells) {
      if (cells.size() == 0) continue;
      const auto block = make_elastic_block({cells.type, cells.nodes, cells.interior, 1000},
                                            mesh_.rest_positions, properties(1e4, 0.3).material, {});
      smallest = std::min(smallest, block->stable_step(x_.local().data()).undamped);
    }
    return over_ranks(smallest, MPI_MIN);
  }

  DistributedMesh mesh_ = box_with_flat_cells(GetParam());
  ElasticForces elastic_{mesh_, std::vector{properties(1e4, 0.3)}};
  NodeField x_{mesh_};
};

TEST_P(FlatCells, AreCreditedWithTheMassOfTheirNeighbours) {
  const double limit = true_limit();
  EXPECT_LE(bound(), limit * (1 + 1e-6));
  EXPECT_GE(bound(), 0.8 * limit);
  // With its own mass a flat cell asks for a step like its height; like the root of it is needed.
  EXPECT_LT(bound_of_own_masses(), 3 * std::sqrt(GetParam()) * limit);
}

TEST_P(FlatCells, KeepTheBoundWhenTheMaterialChanges) {
  const double before = bound();
  elastic_.set_properties(0, properties(4e4, 0.3));
  EXPECT_NEAR(bound(), before / 2, 1e-12 * before);
  elastic_.set_properties(0, properties(1e4, 0.45));
  const double limit = true_limit();
  EXPECT_LE(bound(), limit * (1 + 1e-6));
  EXPECT_GE(bound(), 0.8 * limit);
  elastic_.set_properties(0, properties(1e4, 0.3));
  EXPECT_NEAR(bound(), before, 1e-12 * before);
}

TEST_P(FlatCells, OfNoStiffnessLimitNoStep) {
  elastic_.set_properties(0, properties(0, 0.3));
  EXPECT_TRUE(std::isinf(bound()));
  elastic_.set_properties(0, properties(1e4, 0.3));
  EXPECT_TRUE(std::isfinite(bound()));
}

INSTANTIATE_TEST_SUITE_P(Heights, FlatCells, testing::Values(1e-2, 1e-4));

}  // namespace
}  // namespace evert
