#pragma once
#include "evert/integrators/system.hpp"

/// What schemes need that take damping forces −C(x) v explicitly, as they do elastic ones.
namespace evert {

/// Collective. `force` = f − C(x) v of `system` at velocities `v`, on owned nodes [N].
void damped_force(const System& system, NodeField& v, NodeField& force);

/// Collective. The largest step [s] that this rank's elements allow with 4 M − 2 Δt C − Δt² K positive
/// semidefinite, C and K at the present state: for a mode of frequency ω and damping ratio ξ, Δt ≤ 2 (√(ξ² +
/// 1) − ξ)/ω. PHYSICS 5
///
/// From the bounds ω² of the elements (ElasticBlock::stable_step) and rates r of their damping, λmax(M⁻¹C) ≤
/// r: Δt = 4/(r + √(r² + 4ω²)). As rigorous as the bounds of the elements.
[[nodiscard]] double explicitly_damped_step(const System& system);

}  // namespace evert
