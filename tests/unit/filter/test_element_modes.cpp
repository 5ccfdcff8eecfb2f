// The vibrations of single tetrahedra and the filter in strains, against the dense problems that they stand
// for.
#include <gtest/gtest.h>

#include "dense_modes.hpp"
#include <algorithm>
#include <array>
#include <cstdio>

namespace evert::test {
namespace {

constexpr int trials = 300;

/// As test::verify, which needs MPI.
void tell(const char* what, const char* expected, double found, const char* tolerance) {
  std::printf("verify: %s | %s | %.6g | %s\n", what, expected, found, tolerance);
}

/// Calls look(shape, masses, lame) for tetrahedra of all kinds; every other one with equal masses, ρV/4.
template <class Look>
void for_many_tetrahedra(Look&& look) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> ratio(-0.5, 0.49);
  for (int trial = 0; trial < trials; ++trial) {
    const TetShape shape = shape_of(random_corners(random, trial, std::pow(10, -(trial % 4))));
    TetMasses masses = random_masses(random);
    if (trial % 2 == 0) masses.fill(1000 * shape.volume / 4);
    look(shape, masses, Lame::from_young_poisson(1e4, ratio(random)), random);
  }
}

TEST(ElementModes, AreThoseOfTheDenseProblem) {
  double worst = 0;
  for_many_tetrahedra(
      [&](const TetShape& shape, const TetMasses& masses, const Lame& lame, auto& /*random*/) {
        const auto modes = element_modes(shape, masses, lame);
        std::array<double, 12> ours{};
        for (std::size_t k = 0; k < 3; ++k) {
          ours[6 + k] = modes.stretches[k];
          ours[9 + k] = modes.shears[k];
        }
        std::sort(ours.begin(), ours.end());
        const Matrix12 scaled = mass_scaled(dense_stiffness(shape, lame), masses);
        const auto dense =
            Eigen::SelfAdjointEigenSolver<Matrix12>(scaled, Eigen::EigenvaluesOnly).eigenvalues().eval();
        for (int i = 0; i < 12; ++i)
          worst = std::max(worst, std::abs(dense[i] - ours[static_cast<std::size_t>(i)]) / dense[11]);
        EXPECT_NEAR(modes.largest(), dense[11], 1e-9 * dense[11]);
      });
  EXPECT_LE(worst, 1e-9);
  tell("modal filter: eigenvalues of elements by two 3x3 problems and by 12x12", "the same", worst,
       "1e-9 of the largest");
}

/// V Bᵀ Aᵀ E A B, column by column.
Matrix12 filtered_stiffness(const TetShape& shape, const Lame& lame, const StrainFilter& filter) {
  Matrix12 k;
  for (int column = 0; column < 12; ++column) {
    Vec3d unit{};
    unit[static_cast<std::size_t>(column % 3)] = 1;
    Mat3d strain = outer(unit, shape.gradients[static_cast<std::size_t>(column / 3)]);
    strain = 0.5 * (strain + transpose(strain));
    const Mat3d softened = filter(transpose_times(filter.axes, strain * filter.axes));
    const Mat3d stress = 2 * lame.mu * softened + (lame.lambda * trace(softened)) * identity<double>();
    const Mat3d turned_back = filter.axes * times_transpose(filter.transposed(stress), filter.axes);
    for (std::size_t a = 0; a < 4; ++a) {
      const Vec3d force = shape.volume * (turned_back * shape.gradients[a]);
      for (std::size_t i = 0; i < 3; ++i) k(Eigen::Index(3 * a + i), column) = force[i];
    }
  }
  return k;
}

TEST(StrainFilter, ClampsTheEigenvaluesOfTheElement) {
  double worst = 0, rigid = 0;
  for_many_tetrahedra([&](const TetShape& shape, const TetMasses& masses, const Lame& lame, auto& random) {
    const auto modes = element_modes(shape, masses, lame);
    const double limit =
        std::pow(10, std::uniform_real_distribution<double>(-4, 0.2)(random)) * modes.largest();
    const auto filter = strain_filter(modes, lame, limit);
    const Matrix12 k = filtered_stiffness(shape, lame, filter);
    const Matrix12 full = dense_stiffness(shape, lame);
    const Matrix12 expected = dense_filtered(full, masses, limit);
    const auto size = [&](const Matrix12& m) { return mass_scaled(m, masses).norm(); };
    worst = std::max(worst, size(k - expected) / size(full));
    EXPECT_LE(largest_eigenvalue_of(mass_scaled(k, masses)), limit * (1 + 1e-9));
    EXPECT_LE(largest_eigenvalue(shape, masses, lame, filter), limit * (1 + 1e-9));

    Eigen::Matrix<double, 12, 6> motions = Eigen::Matrix<double, 12, 6>::Zero();
    const Mat3d edges = inverse(Mat3d{shape.gradients[1], shape.gradients[2], shape.gradients[3]});
    for (int a = 0; a < 4; ++a) {
      motions.block<3, 3>(3 * a, 0).setIdentity();
      if (a == 0) continue;  // the origin
      const auto x = [&](std::size_t i) { return edges(static_cast<std::size_t>(a - 1), i); };
      motions.block<3, 3>(3 * a, 3) << 0, x(2), -x(1), -x(2), 0, x(0), x(1), -x(0), 0;
    }
    for (int m = 0; m < 6; ++m)
      rigid = std::max(rigid, (k * motions.col(m)).norm() / (k.norm() * motions.col(m).norm()));
  });
  EXPECT_LE(worst, 1e-9);
  EXPECT_LE(rigid, 1e-12);
  tell("modal filter: K' of elements by strains and by the dense eigenvectors", "the same", worst,
       "1e-9 of K");
  tell("modal filter: forces of K' for rigid motions, relative", "0", rigid, "1e-12");
}

TEST(StrainFilter, IsKnownAgainstOtherMasses) {
  for_many_tetrahedra([&](const TetShape& shape, const TetMasses& masses, const Lame& lame, auto& random) {
    const auto modes = element_modes(shape, masses, lame);
    const auto filter = strain_filter(modes, lame, 0.1 * modes.largest());
    const TetMasses others = random_masses(random);
    const double dense = largest_eigenvalue_of(mass_scaled(filtered_stiffness(shape, lame, filter), others));
    EXPECT_NEAR(largest_eigenvalue(shape, others, lame, filter), dense, 1e-9 * dense);
  });
}

TEST(StrainFilter, OfModesBelowTheLimitChangesNothing) {
  for_many_tetrahedra(
      [&](const TetShape& shape, const TetMasses& masses, const Lame& lame, auto& /*random*/) {
        const auto modes = element_modes(shape, masses, lame);
        const auto filter = strain_filter(modes, lame, modes.largest());
        EXPECT_EQ(filter.stretch, identity<double>());
        EXPECT_EQ(filter.shear, (Vec3d{1, 1, 1}));
      });
}

}  // namespace
}  // namespace evert::test
