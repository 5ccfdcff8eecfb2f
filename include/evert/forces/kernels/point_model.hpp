#pragma once
#include "evert/forces/kernels/cell_batch.hpp"
#include "evert/materials/fibres.hpp"

/// A model as it is at a quadrature point: those with fibres take the direction there.
namespace evert::kernels {

/// Direction of the fibres at point q of a batch, one per lane; (0, 0, 0) in padding lanes.
template <Real T, const auto& element>
EVERT_ALWAYS_INLINE Vec3<T> fibre_direction(const BlockArrays& block, LocalIndex batch, std::size_t q) {
  const auto point = static_cast<std::size_t>(batch) * element.points + q;
  return load_vector<T>(static_cast<const scalar_t<T>*>(block.fibres) + 3 * lanes_v<T> * point);
}

/// `model`, or what it is along its fibres at point q of a batch.
template <Real T, const auto& element, class Model>
EVERT_ALWAYS_INLINE decltype(auto) model_at(const Model& model, const BlockArrays& block, LocalIndex batch,
                                            std::size_t q) {
  if constexpr (HasFibres<Model>) {
    return model.along(fibre_direction<T, element>(block, batch, q));
  } else {
    return (model);
  }
}

}  // namespace evert::kernels
