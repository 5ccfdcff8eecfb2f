#pragma once
#include "evert/integrators/step_report.hpp"
#include "evert/integrators/system.hpp"

#include <span>

namespace evert {

class DampingSolver;

/// What the two Euler schemes share.
///
/// Collective. M vⁿ⁺¹ = M vⁿ + Δt (f(xⁿ) − C(xⁿ) vⁿ) with held nodes as prescribed at the end of the step,
/// and the account of what that took. `force` and `right` are scratch.
void euler_kick(System& system, DampingSolver& solver, NodeField& force, Vec right, double dt);

/// Collective. xⁿ⁺¹ = xⁿ + Δt `velocity`, out of obstacles, with impacts and friction; forces and time at the
/// end of the step. All that obstacles exert is in their impacts: no solve follows for friction to be in.
StepReport euler_drift(System& system, const NodeField& velocity, double dt);

}  // namespace evert
