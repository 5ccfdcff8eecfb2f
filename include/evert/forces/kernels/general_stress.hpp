#pragma once
#include "evert/forces/kernels/point_run.hpp"

#include <concepts>

/// Stresses of models that need U and V: plastic flow, anything whose P̂ = Uᵀ P V is not diagonal.
/// What a model offers decides at compile time; isotropic models never form U and V (force_kernels.hpp).
namespace evert::kernels {

/// The model offers, for one SVD over any scalar T, P̂ = Uᵀ P V [Pa], a full matrix, as
/// `stress_in_frames(svd)`, and ψ [Pa] as `energy(svd)`.
template <class Model>
concept NeedsFrames = requires(const Model& model, const Svd3<double>& svd) {
  { model.stress_in_frames(svd) } -> std::same_as<Mat3d>;
  { model.energy(svd) } -> std::same_as<double>;
};

/// An isotropic model that goes the long way: to compare the two.
template <class Isotropic>
struct InFrames {
  Isotropic model;

  template <class T>
  EVERT_ALWAYS_INLINE T energy(const Svd3<T>& svd) const {
    return model.energy(svd.sigma);
  }
  template <class T>
  EVERT_ALWAYS_INLINE Mat3<T> stress_in_frames(const Svd3<T>& svd) const {
    return diagonal(model.principal_stress(svd.sigma));
  }
};

/// What a run of such a model holds besides PointRun.
template <Real T>
struct FramedRun {
  typename PointRun<T>::template PerPoint<Svd3<T>> svd;
  typename PointRun<T>::template PerPoint<Mat3<T>> stress;  ///< −|∂X/∂ξ| W P̂, then −|∂X/∂ξ| W P
};

/// U, σ and V of a diagonalised run.
template <Real T>
EVERT_STAGE void singular_vector_stage(const PointRun<T>& run, std::size_t points, FramedRun<T>& framed) {
  for (std::size_t i = 0; i < points; ++i) framed.svd[i] = assemble_svd3(run.deflation(i));
}

/// −|∂X/∂ξ| W P̂.  paper A, section 6
template <Real T, const auto& element, NeedsFrames Model>
EVERT_STAGE void framed_stress_stage(const Model& model, const BlockArrays& block, BatchRange batches,
                                     FramedRun<T>& framed) {
  std::size_t i = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const CellBatch<T, element> batch(block, b);
    for (std::size_t q = 0; q < batch.points; ++q, ++i)
      framed.stress[i] = -batch.volume(q) * model.stress_in_frames(framed.svd[i]);
  }
}

/// P = U P̂ Vᵀ.  paper A, eq. (2)
template <Real T>
EVERT_STAGE void turn_stress_stage(std::size_t points, FramedRun<T>& framed) {
  for (std::size_t i = 0; i < points; ++i) {
    const Svd3<T>& svd = framed.svd[i];
    framed.stress[i] = times_transpose(svd.u * framed.stress[i], svd.v);
  }
}

/// −|∂X/∂ξ| W P at every point of a diagonalised run, in `framed.stress`.
template <Real T, const auto& element, NeedsFrames Model>
EVERT_ALWAYS_INLINE void general_stress(const Model& model, const BlockArrays& block, BatchRange batches,
                                        const PointRun<T>& run, std::size_t points, FramedRun<T>& framed) {
  singular_vector_stage(run, points, framed);
  framed_stress_stage<T, element>(model, block, batches, framed);
  turn_stress_stage(points, framed);
}

}  // namespace evert::kernels
