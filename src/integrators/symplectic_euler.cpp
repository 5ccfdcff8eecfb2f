#include "evert/integrators/symplectic_euler.hpp"

#include "evert/integrators/explicit_damping.hpp"

#include "euler_step.hpp"
#include <algorithm>

namespace evert {

SymplecticEuler::SymplecticEuler(const System& system)
    : solver_(DampingSolver::without_damping(system.mesh, system.elastic, system.implicit_strains)),
      scratch_(system.mesh) {
  check(VecCreateMPI(system.mesh.comm, 3 * system.mesh.owned_nodes, PETSC_DETERMINE, right_.out()));
}

double SymplecticEuler::stable_step(const System& system) { return explicitly_damped_step(system); }

/// M vⁿ⁺¹ = M vⁿ + Δt (f(xⁿ) − C(xⁿ) vⁿ),  xⁿ⁺¹ = xⁿ + Δt vⁿ⁺¹
StepReport SymplecticEuler::advance(System& system, double dt) {
  euler_kick(system, solver_, scratch_, right_.get(), dt);
  // A copy, since collisions change the velocity by the one that led to them.
  std::copy(system.v.owned().begin(), system.v.owned().end(), scratch_.owned().begin());
  return euler_drift(system, scratch_, dt);
}

}  // namespace evert
