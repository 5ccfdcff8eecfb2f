#pragma once
#include "evert/filter/element_modes.hpp"
#include "evert/forces/elastic_block.hpp"

#include <memory>
#include <span>

namespace evert {

/// How an element is to be filtered: no eigenvalue of its stiffness at rest against `masses` above `limit`.
struct CellClamp {
  TetMasses masses{};  ///< M*, on its four nodes [kg]
  double limit = 0;    ///< [1/s²]

  friend bool operator==(const CellClamp&, const CellClamp&) = default;
};

/// A block of filtered linear tetrahedra, one clamp a cell, of any isotropic model and damping: it has
/// elastic and damping forces of E' in place of E, with any rotation, flat and inverted.  PHYSICS 9
///
/// With F = U Σ Vᵀ, R = U Vᵀ and S = V Σ Vᵀ: S̃ = I + A (S − I); σ(S̃) the stress of the model in the principal
/// axes of S̃; P = R Aᵀ σ. Its tangent at rest is E' exactly, and of `rotated_linear` P = R E' (S − I). These
/// forces are no gradient and have a torque, which is taken off cell by cell. Damping is that of E' as well:
/// A stands on both sides of its operator. In double precision. Not for models with fibres, nor for cells
/// without volume.
[[nodiscard]] std::unique_ptr<ElasticBlock> make_filtered_block(const ElasticCells& cells,
                                                                std::span<const Vec3d> rest_positions,
                                                                const Material& material,
                                                                const Damping& damping,
                                                                std::span<const CellClamp> clamps);

}  // namespace evert
