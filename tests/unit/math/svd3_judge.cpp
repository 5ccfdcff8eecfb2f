#include "svd3_judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace evert::test {

namespace {

using Real80 = long double;
using Matrix = Mat3<Real80>;
using Vector = Vec3<Real80>;

constexpr Real80 double_epsilon = std::numeric_limits<double>::epsilon();

Matrix matrix_at(const std::vector<double>& entries, std::size_t i) {
  const std::size_t count = entries.size() / 9;
  Matrix m;
  for (std::size_t c = 0; c < 9; ++c) m(c % 3, c / 3) = entries[c * count + i];
  return m;
}

Vector vector_at(const std::vector<double>& entries, std::size_t i) {
  const std::size_t count = entries.size() / 3;
  return {entries[i], entries[count + i], entries[2 * count + i]};
}

Real80 nan_is_infinite(Real80 error) {
  return std::isnan(error) ? std::numeric_limits<Real80>::infinity() : error;
}

Real80 relative_difference(const Matrix& a, const Matrix& f) {
  const Real80 size = norm(f);
  return nan_is_infinite(norm(a - f) / (size > 0 ? size : 1));
}

Real80 distance_from_orthonormal(const Matrix& q) {
  return nan_is_infinite(norm(transpose_times(q, q) - identity<Real80>()));
}

/// Whether the sign of σ3 contradicts det F. It is determined where |σ3| is well above the rounding of σ1;
/// the determinant itself is, where it is above the rounding of long double.
bool contradicts_determinant(const Vector& sigma, Real80 determinant_of_f) {
  const Real80 rounding_of_sigma3 = 16 * double_epsilon * sigma[0] * sigma[0] * sigma[1];
  const Real80 rounding_of_determinant = 16 * std::numeric_limits<Real80>::epsilon() * std::pow(sigma[0], 3);
  const bool certain = std::abs(determinant_of_f) > std::max(rounding_of_sigma3, rounding_of_determinant);
  return certain && (sigma[2] < 0) != (determinant_of_f < 0);
}

void judge_svd(const Matrix& f, const Matrix& u, const Vector& sigma, const Matrix& v, Verdict& verdict) {
  verdict.reconstruction = relative_difference(times_transpose(u * diagonal(sigma), v), f);
  verdict.orthonormality = std::max(distance_from_orthonormal(u), distance_from_orthonormal(v));
  const bool ordered = sigma[0] >= sigma[1] && sigma[1] >= std::abs(sigma[2]);
  verdict.misordered = ordered ? 0 : 1;
  verdict.wrong_sign = contradicts_determinant(sigma, determinant(f)) ? 1 : 0;
  verdict.not_rotations = determinant(u) > 0 && determinant(v) > 0 ? 0 : 1;
}

void judge_isotropic(const Matrix& f, const Vector& sigma, const Vector& stretches, const Matrix& tensor,
                     const Matrix& rotation, Verdict& verdict) {
  verdict.isotropic = relative_difference(tensor, f);
  verdict.rotation = distance_from_orthonormal(rotation);
  if (!(determinant(rotation) > 0)) ++verdict.not_rotations;
  std::array sorted{stretches[0], stretches[1], stretches[2]};
  std::ranges::sort(sorted, [](Real80 a, Real80 b) { return std::abs(a) > std::abs(b); });
  for (std::size_t k = 0; k < 3; ++k) {
    // Magnitudes, because ±σ2 and ∓σ3 of equal magnitude may stand in either order.
    const Real80 difference = std::abs(std::abs(sorted[k]) - std::abs(sigma[k]));
    if (!(difference <= 1e-14L * sigma[0])) verdict.wrong_stretches = 1;
  }
}

}  // namespace

void MatrixArray::set(std::size_t i, const Mat3d& f) {
  for (std::size_t c = 0; c < 9; ++c) entries_[c * count_ + i] = f(c % 3, c / 3);
}

Mat3d MatrixArray::get(std::size_t i) const {
  Mat3d f;
  for (std::size_t c = 0; c < 9; ++c) f(c % 3, c / 3) = entries_[c * count_ + i];
  return f;
}

long double Verdict::largest_error() const {
  return std::max({reconstruction, orthonormality, isotropic, rotation});
}

void Verdict::merge(const Verdict& other) {
  if (other.largest_error() > largest_error()) worst = other.worst;
  reconstruction = std::max(reconstruction, other.reconstruction);
  orthonormality = std::max(orthonormality, other.orthonormality);
  isotropic = std::max(isotropic, other.isotropic);
  rotation = std::max(rotation, other.rotation);
  disagreement = std::max(disagreement, other.disagreement);
  misordered += other.misordered;
  wrong_sign += other.wrong_sign;
  not_rotations += other.not_rotations;
  wrong_stretches += other.wrong_stretches;
}

std::ostream& operator<<(std::ostream& out, const Verdict& verdict) {
  out << "reconstruction " << verdict.reconstruction << ", orthonormality " << verdict.orthonormality
      << ", isotropic " << verdict.isotropic << ", rotation " << verdict.rotation << ", disagreement "
      << verdict.disagreement << "; worst F (hexadecimal, by columns):";
  out << std::hexfloat;
  for (const auto& column : verdict.worst.column) {
    for (const double entry : column.components) out << ' ' << entry;
  }
  return out << std::defaultfloat;
}

Verdict judge(const LevelKernels& level, const MatrixArray& matrices) {
  const std::size_t count = matrices.count();
  std::vector<double> u(9 * count), sigma(3 * count), v(9 * count);
  level.svd3(matrices.data(), {u.data(), sigma.data(), v.data()}, count);
  std::vector<double> stretches(3 * count), tensor(9 * count), rotation(9 * count), disagreement(count);
  level.isotropic(matrices.data(), {stretches.data(), tensor.data(), rotation.data(), disagreement.data()},
                  count);

  Verdict all;
  for (std::size_t i = 0; i < count; ++i) {
    const Mat3d f = matrices.get(i);
    Matrix wide;
    for (std::size_t c = 0; c < 9; ++c) wide(c % 3, c / 3) = f(c % 3, c / 3);
    Verdict one;
    judge_svd(wide, matrix_at(u, i), vector_at(sigma, i), matrix_at(v, i), one);
    judge_isotropic(wide, vector_at(sigma, i), vector_at(stretches, i), matrix_at(tensor, i),
                    matrix_at(rotation, i), one);
    one.disagreement = nan_is_infinite(disagreement[i]);
    one.worst = f;
    all.merge(one);
  }
  return all;
}

void expect_accurate(const Verdict& verdict, long double bound) {
  EXPECT_LE(verdict.reconstruction, bound) << verdict;
  EXPECT_LE(verdict.orthonormality, bound) << verdict;
  EXPECT_LE(verdict.isotropic, bound) << verdict;
  EXPECT_LE(verdict.rotation, bound) << verdict;
  EXPECT_LE(verdict.disagreement, bound) << verdict;
  EXPECT_EQ(verdict.misordered, 0U) << verdict;
  EXPECT_EQ(verdict.wrong_sign, 0U) << verdict;
  EXPECT_EQ(verdict.not_rotations, 0U) << verdict;
  EXPECT_EQ(verdict.wrong_stretches, 0U) << verdict;
}

}  // namespace evert::test
