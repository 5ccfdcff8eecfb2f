#pragma once
#include "evert/forces/kernels/cell_batch.hpp"
#include "evert/materials/fibres.hpp"

namespace evert::kernels {

/// Where point `i` of a run of `piece` stands in the block.
struct PointPlace {
  LocalIndex batch;
  std::size_t q;
};
template <const auto& element>
EVERT_ALWAYS_INLINE PointPlace place_of(BatchRange piece, std::size_t i) {
  return {piece.begin + static_cast<LocalIndex>(i / element.points), i % element.points};
}

/// Direction of the fibres at a point, one per lane; (0, 0, 0) in padding lanes.
template <Real T, const auto& element>
EVERT_ALWAYS_INLINE Vec3<T> fibre_direction(const BlockArrays& block, const PointPlace& place) {
  const auto point = static_cast<std::size_t>(place.batch) * element.points + place.q;
  return load_vector<T>(static_cast<const scalar_t<T>*>(block.fibres) + 3 * lanes_v<T> * point);
}

}  // namespace evert::kernels
