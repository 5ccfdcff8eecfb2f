#pragma once
#include "evert/core/aligned.hpp"
#include "evert/elements/element_block.hpp"
#include "evert/materials/lame.hpp"

#include <span>
#include <vector>

/// What the stable step of an element starts from.  PHYSICS 9, eq. (9)
namespace evert {

class PlasticCells;

/// What the stable step of the cells starts from, per lane of a block, 0 in padding, rounded up to float so
/// that a bound stays one [1/s²].
struct RestStiffness {
  AlignedVector<float> largest;  ///< λ_e
  AlignedVector<float> spin;     ///< λ_spin ≤ λ_e: 2μ V times the second largest of Γ (below)
};

/// λ_e is the largest eigenvalue of the stiffness that
/// tangent_bound.hpp compares with, Σ_q V_q B_qᵀ (2μ I + λ I⊗I) B_q, against M*_e = diag(`mass_shares`), the
/// cell's shares m_ea of the lumped masses of its nodes [kg], node_count per cell. Where the shares sum to
/// the mass of every node, the largest λ_e of a mesh bounds that of its M⁻¹K rigorously, however they are
/// chosen.
///
/// For linear tetrahedra λ_e = V max eig {2μ Γ, Γ^½ (2μ I + λ 11ᵀ) Γ^½}, Γ = the eigenvalues of Σ_a g_a g_aᵀ
/// / m_ea over the shape gradients g_a; with λ ≥ 0 that is the element's exact largest eigenvalue at rest.
///
/// λ_spin is what resists a spin when strain is held by damping (stable_steps in measure_kernels.hpp): of a
/// flat cell, the large eigenvalue of Γ does not count. Cells of several points are not looked into: λ_e.
[[nodiscard]] RestStiffness rest_stiffness(const ElementBlock& block, std::span<const double> mass_shares,
                                           const Lame& lame, const PlasticCells* flown = nullptr);
/// The same of the cell in one lane anew. `flown`: what has flown in the block, if anything can.
void update_rest_stiffness(const ElementBlock& block, std::span<const double> mass_shares, const Lame& lame,
                           const PlasticCells* flown, std::size_t slot, RestStiffness& stiffness);

/// The shares that a cell contributed itself, ∫ ρ N_a dX: eq. (9) as printed.
[[nodiscard]] std::vector<double> own_mass_shares(const ElementBlock& block, double density);

}  // namespace evert
