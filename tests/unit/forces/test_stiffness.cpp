#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "bodies.hpp"

/// The stiffness matrices of the cells: the derivative of the forces, symmetric, and positive semidefinite
/// when projected.
namespace evert::test {
namespace {

/// The models with their extensions, and muscle that pulls: stretched, its active part has a negative
/// stiffness.
std::vector<Material> models_to_look_at() {
  std::vector<Material> all = all_materials();
  Muscle strong = active_muscle(1);
  strong.peak_stress = 50 * soft.mu;
  all.push_back(strong);
  return all;
}

/// K v of all cells, and the largest difference of K to its transpose.
struct Product {
  NodalValues kv;
  double asymmetry = 0;
};

Product stiffness_product(const ElasticBlock& block, const NodalValues& x, TangentForm form,
                          const NodalValues& v) {
  Product product{NodalValues(x.size(), 0.0)};
  block.stiffness_matrices(x.data(), form, [&](LocalIndex cell, std::span<const double> k) {
    const auto nodes = block.cell_nodes(cell);
    const std::size_t n = 3 * nodes.size();
    const auto at = [&](std::size_t i) { return 3 * static_cast<std::size_t>(nodes[i / 3]) + i % 3; };
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        product.kv[at(i)] += k[i * n + j] * v[at(j)];
        product.asymmetry = std::max(product.asymmetry, std::abs(k[i * n + j] - k[j * n + i]));
      }
  });
  return product;
}

NodalValues moved(const NodalValues& x, double step, const NodalValues& v) {
  NodalValues sum = x;
  for (std::size_t i = 0; i + 1 < sum.size(); ++i) sum[i] += step * v[i];
  return sum;
}

class Stiffness : public testing::TestWithParam<CellType> {
 protected:
  Body body_ = box(GetParam(), 2, 2, 1);
  NodalValues v_ = random_velocities(body_.rest.size());
};

TEST_P(Stiffness, IsTheDerivativeOfTheForces) {
  constexpr double step = 1e-7;  // of edges of 0.1: forces are linear there but for one part in 10^6
  for (const auto& material : models_to_look_at()) {
    if (!has_a_potential(material)) continue;
    const auto block = scalar_block(body_, material, no_damping);
    for (const auto& state : awkward_states(body_)) {
      // The others have points at the edge where models have a kink, or none of the tangents is unique.
      if (state.name != std::string("bent") && state.name != std::string("turned") &&
          state.name != std::string("inside out"))
        continue;
      const auto ahead = forces(*block, moved(state.x, step, v_)),
                 behind = forces(*block, moved(state.x, -step, v_));
      const auto [kv, asymmetry] = stiffness_product(*block, state.x, TangentForm::full, v_);
      NodalValues differences(kv.size(), 0.0);
      for (std::size_t i = 0; i + 1 < kv.size(); ++i) differences[i] = (behind[i] - ahead[i]) / (2 * step);
      EXPECT_LE(largest_difference(kv, differences), 1e-5 * largest(kv))
          << name_of(material) << ", " << state.name;
      EXPECT_LE(asymmetry, 1e-12 * largest(kv)) << name_of(material) << ", " << state.name;
    }
  }
}

/// The smallest eigenvalue of the matrices of all cells, each over the largest of its own.
struct Spectrum {
  double least = 0;  ///< projected
  double least_before_projection = 0;
};

Spectrum spectrum_of(const ElasticBlock& block, const NodalValues& x) {
  const auto least = [&](TangentForm form) {
    double smallest = 0;
    block.stiffness_matrices(x.data(), form, [&](LocalIndex cell, std::span<const double> k) {
      const auto n = static_cast<Eigen::Index>(3 * block.cell_nodes(cell).size());
      const Eigen::Map<const Eigen::MatrixXd> matrix(k.data(), n, n);
      const Eigen::VectorXd values =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
      smallest = std::min(smallest, values.minCoeff() / values.cwiseAbs().maxCoeff());
    });
    return smallest;
  };
  return {least(TangentForm::projected), least(TangentForm::full)};
}

TEST_P(Stiffness, IsPositiveSemidefiniteWhenProjected) {
  for (const auto& material : models_to_look_at()) {
    const auto block = scalar_block(body_, material, no_damping);
    double before = 0;
    for (const auto& state : awkward_states(body_)) {
      const Spectrum spectrum = spectrum_of(*block, state.x);
      EXPECT_GE(spectrum.least, -1e-12) << name_of(material) << ", " << state.name;
      before = std::min(before, spectrum.least_before_projection);
    }
    EXPECT_LT(before, -1e-3) << name_of(material) << " had nothing to be taken off";
  }
}

/// Stretched muscle pulls less: fibres alone make its tangent indefinite.
TEST_P(Stiffness, LosesTheNegativePartOfFibres) {
  Muscle strong = active_muscle(1);
  strong.peak_stress = 50 * soft.mu;
  const auto block = scalar_block(body_, strong, no_damping);
  const NodalValues stretched = deformed(body_, [](const Vec3d& p) { return 1.3 * p; });
  const Spectrum spectrum = spectrum_of(*block, stretched);
  EXPECT_GE(spectrum.least, -1e-12);
  EXPECT_LT(spectrum.least_before_projection, -1e-3);
}

TEST_P(Stiffness, KnowsNoTranslation) {
  const auto block = scalar_block(body_, all_materials().front(), no_damping);
  const auto state = awkward_states(body_).front();
  const auto shift = nodal_values(std::vector<Vec3d>(body_.rest.size(), Vec3d{1, -2, 0.5}));
  const auto reference = largest(stiffness_product(*block, state.x, TangentForm::full, v_).kv);
  EXPECT_LE(largest(stiffness_product(*block, state.x, TangentForm::full, shift).kv), 1e-12 * reference);
}

std::string name_of_type(const testing::TestParamInfo<CellType>& info) {
  return std::string(evert::name_of(info.param));
}

INSTANTIATE_TEST_SUITE_P(All, Stiffness, testing::ValuesIn(all_elements), name_of_type);

}  // namespace
}  // namespace evert::test
