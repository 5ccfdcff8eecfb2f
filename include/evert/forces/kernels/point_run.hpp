#pragma once
#include "evert/forces/kernels/cell_batch.hpp"
#include "evert/math/svd3_run.hpp"

#include <array>

/// A run of quadrature points on its way from positions to stresses.
namespace evert::kernels {

template <Real T>
struct PointRun : Svd3Run<T> {
  typename Svd3Run<T>::template PerPoint<Vec3<T>> principal;  ///< P̂, in the order of principal_stretches()
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
