#pragma once
#include "evert/forces/kernels/cell_batch.hpp"
#include "evert/math/svd3.hpp"

#include <algorithm>
#include <array>

/// Diagonalisation of the deformation gradient at a run of quadrature points.  paper A, section 5
///
/// The work on one point is a long chain of dependent operations. It is cut into short stages, each a loop of
/// its own over a run of points that stays in L1: an out-of-order core then works on several points at once,
/// where the whole chain of one would overflow its registers and its window.
namespace evert::kernels {

template <Real T>
struct PointRun {
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
  PerPoint<Vec3<T>> principal;             ///< P̂, in the order of principal_stretches()
};

/// Batches that fill a run.
template <Real T, const auto& element>
inline constexpr LocalIndex batches_per_run = PointRun<T>::capacity / element.points;

/// F at every point of `batches`, in order.
template <Real T, const auto& element>
EVERT_STAGE void gather_field_gradients(const BlockArrays& block, const double* field, BatchRange batches,
                                        Mat3<T>* gradients) {
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const CellBatch<T, element> batch(block, b);
    batch.shape.field_gradients(batch.edges_of(field),
                                [&](std::size_t q, const Mat3<T>& gradient) { gradients[q] = gradient; });
    gradients += batch.points;
  }
}

template <Real T>
EVERT_STAGE void square_stage(PointRun<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) run.square[i] = normalized_square(run.deformation_gradient[i]);
}

template <Real T>
EVERT_STAGE void root_stage(PointRun<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) run.isolated[i] = isolated_root(run.square[i]);
}

template <Real T>
EVERT_STAGE void right_direction_stage(PointRun<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i)
    run.direction[i] = isolated_direction(run.square[i], run.isolated[i]);
}

template <Real T>
EVERT_STAGE void frame_stage(const Vec3<T>* directions, Frame<T>* frames, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) frames[i] = frame_along(directions[i]);
}

template <Real T>
EVERT_STAGE void left_direction_stage(PointRun<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) {
    run.images[i] = images(run.deformation_gradient[i], run.right[i]);
    run.direction[i] = left_direction(run.images[i], run.right[i], run.square[i], run.isolated[i]);
  }
}

template <Real T>
EVERT_STAGE void plane_stage(PointRun<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) run.plane[i] = plane_remainder(run.images[i], run.left[i]);
}

/// F = U F̂ Vᵀ at the first `points` points, in the form that isotropic_tensor() and polar_rotation() take.
/// Entries of F up to 1e70 in magnitude.
template <Real T>
EVERT_ALWAYS_INLINE void diagonalize(PointRun<T>& run, std::size_t points) {
  square_stage(run, points);
  root_stage(run, points);
  right_direction_stage(run, points);
  frame_stage(run.direction.data(), run.right.data(), points);
  left_direction_stage(run, points);
  frame_stage(run.direction.data(), run.left.data(), points);
  plane_stage(run, points);
}

/// Calls `work(piece)` for consecutive pieces of `batches` that fill a run.
template <Real T, const auto& element, class Work>
EVERT_ALWAYS_INLINE void for_each_piece(BatchRange batches, Work&& work) {
  for (LocalIndex first = batches.begin; first < batches.end; first += batches_per_run<T, element>) {
    const LocalIndex last = first + batches_per_run<T, element>;
    work(BatchRange{first, last < batches.end ? last : batches.end});
  }
}

/// Calls `work(run, piece, points)` for each of these pieces, with F of its points in the run.
template <Real T, const auto& element, class Work>
EVERT_ALWAYS_INLINE void for_each_run(const BlockArrays& block, const double* x, BatchRange batches,
                                      Work&& work) {
  PointRun<T> run;
  for_each_piece<T, element>(batches, [&](BatchRange piece) {
    gather_field_gradients<T, element>(block, x, piece, run.deformation_gradient.data());
    work(run, piece, static_cast<std::size_t>(piece.end - piece.begin) * element.points);
  });
}

}  // namespace evert::kernels
