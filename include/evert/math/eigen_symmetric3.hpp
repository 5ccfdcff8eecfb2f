#pragma once
#include "evert/math/vec3.hpp"

namespace evert {

/// A = vectors · diag(values) · vectorsᵀ.
struct SymmetricEigen3 {
  Vec3d values;   ///< ascending
  Mat3d vectors;  ///< orthonormal columns in the order of the values
};

/// Eigenvalues and eigenvectors of a symmetric matrix, for setup code; only the lower triangle is read.
/// Accurate to rounding relative to the largest value. Non-finite input gives NaN.
[[nodiscard]] SymmetricEigen3 eigen_symmetric3(const Mat3d& a);

}  // namespace evert
