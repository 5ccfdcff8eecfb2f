#pragma once
#include "evert/filter/element_modes.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <random>

/// One tetrahedron the long way: dense 12×12 matrices.
namespace evert::test {

using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// K_e = V Bᵀ E B by nodes: V (λ g_a g_bᵀ + μ (g_b g_aᵀ + g_a·g_b I)).
inline Matrix12 dense_stiffness(const TetShape& shape, const Lame& lame) {
  Matrix12 k;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b) {
      const Vec3d &ga = shape.gradients[a], &gb = shape.gradients[b];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          k(Eigen::Index(3 * a + i), Eigen::Index(3 * b + j)) =
              shape.volume *
              (lame.lambda * ga[i] * gb[j] + lame.mu * ga[j] * gb[i] + (i == j ? lame.mu * dot(ga, gb) : 0));
    }
  return k;
}

/// M*^−½ K M*^−½
inline Matrix12 mass_scaled(const Matrix12& k, const TetMasses& masses) {
  Matrix12 scaled = k;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j)
      scaled(i, j) /=
          std::sqrt(masses[static_cast<std::size_t>(i / 3)] * masses[static_cast<std::size_t>(j / 3)]);
  return scaled;
}

/// Paper B, eq. (10), with eigenvectors in columns: K' = M*^½ Φ min(Λ, limit) Φᵀ M*^½.
inline Matrix12 dense_filtered(const Matrix12& k, const TetMasses& masses, double limit) {
  const Eigen::SelfAdjointEigenSolver<Matrix12> modes(mass_scaled(k, masses));
  const Matrix12 clamped = modes.eigenvectors() * modes.eigenvalues().cwiseMin(limit).asDiagonal() *
                           modes.eigenvectors().transpose();
  TetMasses inverse{};
  for (std::size_t a = 0; a < 4; ++a) inverse[a] = 1 / masses[a];
  return mass_scaled(clamped, inverse);
}

inline double largest_eigenvalue_of(const Matrix12& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Matrix12>(symmetric, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

/// Corners of a tetrahedron of any shape: each third is flat to `height`, each third a needle.
inline std::array<Vec3d, 4> random_corners(std::mt19937_64& random, int kind, double height) {
  std::uniform_real_distribution<double> place(-1, 1);
  std::array<Vec3d, 4> x{};
  do {
    for (Vec3d& corner : x) corner = {place(random), place(random), place(random)};
    for (Vec3d& corner : x) {
      if (kind % 3 == 1) corner[2] *= height;
      if (kind % 3 == 2) corner[1] *= height, corner[2] *= height;
    }
    if (dot(x[3] - x[0], cross(x[1] - x[0], x[2] - x[0])) < 0) std::swap(x[0], x[1]);
  } while (!(dot(x[3] - x[0], cross(x[1] - x[0], x[2] - x[0])) > 0));
  return x;
}

inline TetShape shape_of(const std::array<Vec3d, 4>& corners) {
  constexpr std::array<LocalIndex, 4> numbers{0, 1, 2, 3};
  return tet_shape(numbers, corners);
}

inline TetMasses random_masses(std::mt19937_64& random) {
  std::uniform_real_distribution<double> exponent(-2, 2);
  TetMasses masses{};
  for (double& mass : masses) mass = std::pow(10, exponent(random));
  return masses;
}

}  // namespace evert::test
