#pragma once
#include "evert/math/svd3.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

/// The SVD of a run of matrices, stage by stage.  paper A, section 5
///
/// The work on one matrix is a long chain of dependent operations. It is cut into short stages, each a loop
/// of its own over a run of points that stays in L1: an out-of-order core then works on several points at
/// once, where the whole chain of one would overflow its registers and its window.
namespace evert {

template <Real T>
struct Svd3Run {
  /// Enough points to hide latency, few enough for L1; never fewer than a hexahedron has.
  static constexpr int capacity = std::max(8, 32 / static_cast<int>(lanes_v<T>));
  template <class Value>
  using PerPoint = std::array<Value, capacity>;

  PerPoint<Mat3<T>> deformation_gradient;  ///< F
  PerPoint<NormalizedSquare<T>> square;    ///< FᵀF and its characteristic cubic
  PerPoint<IsolatedRoot<T>> isolated;      ///< the best separated σ²
  PerPoint<Vec3<T>> direction;             ///< its right, then left, singular vector, not normalised
  PerPoint<Frame<T>> right;                ///< [w u v]
  PerPoint<Mat3<T>> images;                ///< F [w u v]
  PerPoint<Frame<T>> left;                 ///< [l e f]
  PerPoint<PlaneRemainder<T>> plane;       ///< the other two σ

  /// What the stages have found of point i, F = `scale` · what they were given.
  EVERT_ALWAYS_INLINE Deflation<T> deflation(std::size_t i, const T& scale = T(1)) const {
    return {right[i], left[i], plane[i], isolated[i].root, scale};
  }
};

template <Real T>
EVERT_STAGE void square_stage(Svd3Run<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) run.square[i] = normalized_square(run.deformation_gradient[i]);
}

template <Real T>
EVERT_STAGE void root_stage(Svd3Run<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) run.isolated[i] = isolated_root(run.square[i]);
}

template <Real T>
EVERT_STAGE void right_direction_stage(Svd3Run<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i)
    run.direction[i] = isolated_direction(run.square[i], run.isolated[i]);
}

template <Real T>
EVERT_STAGE void frame_stage(const Vec3<T>* directions, Frame<T>* frames, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) frames[i] = frame_along(directions[i]);
}

template <Real T>
EVERT_STAGE void left_direction_stage(Svd3Run<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) {
    run.images[i] = images(run.deformation_gradient[i], run.right[i]);
    run.direction[i] = left_direction(run.images[i], run.right[i], run.square[i], run.isolated[i]);
  }
}

template <Real T>
EVERT_STAGE void plane_stage(Svd3Run<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) run.plane[i] = plane_remainder(run.images[i], run.left[i]);
}

/// F = U F̂ Vᵀ at the first `points` points, in the form that isotropic_tensor() and polar_rotation() take.
/// Entries of F up to 1e70 in magnitude.
template <Real T>
EVERT_ALWAYS_INLINE void diagonalize(Svd3Run<T>& run, std::size_t points) {
  square_stage(run, points);
  root_stage(run, points);
  right_direction_stage(run, points);
  frame_stage(run.direction.data(), run.right.data(), points);
  left_direction_stage(run, points);
  frame_stage(run.direction.data(), run.left.data(), points);
  plane_stage(run, points);
}

}  // namespace evert
