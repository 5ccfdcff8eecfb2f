#include "evert/filter/element_modes.hpp"

#include "evert/math/eigen_symmetric3.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace evert {
namespace {

/// Σ_a g_a g_aᵀ / m_a
Mat3d squared_gradients(const TetShape& shape, const TetMasses& masses) {
  Mat3d sum{};
  for (std::size_t a = 0; a < 4; ++a) sum += (1 / masses[a]) * outer(shape.gradients[a], shape.gradients[a]);
  return sum;
}

/// (2μ I + λ 11ᵀ)^p on the stretches.
Mat3d power_of_elasticity(const Lame& lame, double p) {
  const double shear = std::pow(2 * lame.mu, p);
  const double bulk = std::pow(2 * lame.mu + 3 * lame.lambda, p);
  const double off = (bulk - shear) / 3;
  const double on = off + shear;
  return {{{{on, off, off}, {off, on, off}, {off, off, on}}}};
}

/// Of the shear of the pair of axes without axis k.
Vec3d of_pairs(const Vec3d& of_axes) {
  return {of_axes[1] + of_axes[2], of_axes[0] + of_axes[2], of_axes[0] + of_axes[1]};
}

}  // namespace

TetShape tet_shape(std::span<const LocalIndex> nodes, std::span<const Vec3d> rest_positions) {
  const auto at = [&](std::size_t a) -> const Vec3d& {
    return rest_positions[static_cast<std::size_t>(nodes[a])];
  };
  const Mat3d edges{at(1) - at(0), at(2) - at(0), at(3) - at(0)};
  const double determinant_of_edges = determinant(edges);
  const Mat3d cofactors = cofactor(edges);
  TetShape shape{{}, determinant_of_edges / 6};
  for (std::size_t a = 1; a < 4; ++a) {
    shape.gradients[a] = (1 / determinant_of_edges) * cofactors.column[a - 1];
    shape.gradients[0] -= shape.gradients[a];
  }
  return shape;
}

ElementModes element_modes(const TetShape& shape, const TetMasses& masses, const Lame& lame) {
  auto [squares, axes] = eigen_symmetric3(squared_gradients(shape, masses));
  if (determinant(axes) < 0) axes.column[0] = -axes.column[0];
  const Mat3d root = power_of_elasticity(lame, 0.5);
  const auto [stretches, modes] = eigen_symmetric3(shape.volume * (root * (diagonal(squares) * root)));
  return {axes, modes, stretches, shape.volume * lame.mu * of_pairs(squares)};
}

StrainFilter strain_filter(const ElementModes& modes, const Lame& lame, double limit) {
  const auto factors = [limit](const Vec3d& eigenvalues) {
    Vec3d roots{};
    for (std::size_t k = 0; k < 3; ++k)
      roots[k] = eigenvalues[k] > limit ? std::sqrt(limit / eigenvalues[k]) : 1;
    return roots;
  };
  if (!(modes.stretches[2] > limit)) return {{identity<double>(), factors(modes.shears)}, modes.axes};
  const Mat3d& q = modes.stretch_modes;
  const Mat3d damped = times_transpose(q * diagonal(factors(modes.stretches)), q);
  return {{power_of_elasticity(lame, -0.5) * damped * power_of_elasticity(lame, 0.5), factors(modes.shears)},
          modes.axes};
}

TetMatrix element_stiffness(const TetShape& shape, const Lame& lame) {
  TetMatrix k;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b) {
      const Vec3d &ga = shape.gradients[a], &gb = shape.gradients[b];
      const Mat3d block = shape.volume * (lame.lambda * outer(ga, gb) + lame.mu * outer(gb, ga) +
                                          (lame.mu * dot(ga, gb)) * identity<double>());
      for (std::size_t i = 0; i < 9; ++i) k[12 * (3 * a + i / 3) + 3 * b + i % 3] = block(i / 3, i % 3);
    }
  return k;
}

TetMatrix element_stiffness(const TetShape& shape, const Lame& lame, const StrainFilter& filter) {
  std::array<Vec3d, 4> g;
  for (std::size_t a = 0; a < 4; ++a) g[a] = transpose_times(filter.axes, shape.gradients[a]);
  TetMatrix k;
  for (std::size_t column = 0; column < 12; ++column) {
    const Mat3d change =
        outer(Vec3d{filter.axes(column % 3, 0), filter.axes(column % 3, 1), filter.axes(column % 3, 2)},
              g[column / 3]);
    const Mat3d strain = filter(0.5 * (change + transpose(change)));
    const Mat3d stress =
        filter.transposed(2 * lame.mu * strain + (lame.lambda * trace(strain)) * identity<double>());
    for (std::size_t a = 0; a < 4; ++a) {
      const Vec3d force = shape.volume * (filter.axes * (stress * g[a]));
      for (std::size_t i = 0; i < 3; ++i) k[12 * (3 * a + i) + column] = force[i];
    }
  }
  return k;
}

double largest_eigenvalue(const TetShape& shape, const TetMasses& masses, const Lame& lame,
                          const StrainFilter& filter) {
  // Strains as 6-vectors whose scalar product is that of the tensors: xx yy zz, √2 yz, √2 xz, √2 xy. With E'
  // = Lᵀ L the eigenvalues are those of L N Lᵀ, N = V B M*⁻¹ Bᵀ: e ↦ V (e G + G e)/2.
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  const Mat3d g = transpose_times(filter.axes, squared_gradients(shape, masses) * filter.axes);
  constexpr std::array<std::array<std::size_t, 2>, 6> pairs{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
  Matrix6 n;
  for (int column = 0; column < 6; ++column) {
    const auto [i, j] = pairs[static_cast<std::size_t>(column)];
    Mat3d unit{};
    unit(i, j) = unit(j, i) = i == j ? 1 : std::sqrt(0.5);
    const Mat3d product = unit * g;
    for (int row = 0; row < 6; ++row) {
      const auto [k, l] = pairs[static_cast<std::size_t>(row)];
      const double scale = k == l ? 1 : std::sqrt(2.0);
      n(row, column) = shape.volume * scale * 0.5 * (product(k, l) + product(l, k));
    }
  }
  const Mat3d stretch = power_of_elasticity(lame, 0.5) * filter.stretch;
  Matrix6 l = Matrix6::Zero();
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    for (int j = 0; j < 3; ++j) l(i, j) = stretch(k, static_cast<std::size_t>(j));
    l(3 + i, 3 + i) = std::sqrt(2 * lame.mu) * filter.shear[k];
  }
  const Matrix6 h = l * n * l.transpose();
  return Eigen::SelfAdjointEigenSolver<Matrix6>(h, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

}  // namespace evert
