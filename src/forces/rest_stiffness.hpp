#pragma once
#include "evert/core/aligned.hpp"
#include "evert/elements/element_block.hpp"
#include "evert/materials/lame.hpp"

/// What the stable step of an element starts from.  PHYSICS 9, eq. (9)
namespace evert {

/// Per lane of `block` (0 in padding): λ_e [1/s²], the largest eigenvalue of the stiffness that
/// tangent_bound.hpp compares with, Σ_q V_q B_qᵀ (2μ I + λ I⊗I) B_q, against M*_e, the cell's own shares of
/// the lumped mass: they sum to the mass of every node, so that the largest λ_e of a mesh bounds that of its
/// M⁻¹K rigorously.
///
/// For linear tetrahedra λ_e = (4/ρ) max eig {2μ Γ, Γ^½ (2μ I + λ 11ᵀ) Γ^½}, Γ = the eigenvalues of Σ_a g_a
/// g_aᵀ over the shape gradients g_a; with λ ≥ 0 that is the element's exact largest eigenvalue at rest.
[[nodiscard]] AlignedVector<double> rest_stiffness(const ElementBlock& block, double density,
                                                   const Lame& lame);

}  // namespace evert
