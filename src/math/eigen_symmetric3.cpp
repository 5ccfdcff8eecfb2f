#include "evert/math/eigen_symmetric3.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>

namespace evert {

SymmetricEigen3 eigen_symmetric3(const Mat3d& a) {
  Eigen::Matrix3d matrix;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) matrix(Eigen::Index(i), Eigen::Index(j)) = a(i, j);
  }
  SymmetricEigen3 result;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  const bool solved = matrix.allFinite() && solver.info() == Eigen::Success;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto column = Eigen::Index(j);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    result.values[j] = solved ? solver.eigenvalues()[column] : nan;
    for (std::size_t i = 0; i < 3; ++i) {
      result.vectors(i, j) = solved ? solver.eigenvectors()(Eigen::Index(i), column) : nan;
    }
  }
  return result;
}

}  // namespace evert
