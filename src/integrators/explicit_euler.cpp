#include "evert/integrators/explicit_euler.hpp"

#include "euler_step.hpp"
#include <algorithm>

namespace evert {

ExplicitEuler::ExplicitEuler(const System& system)
    : solver_(DampingSolver::without_damping(system.mesh, system.elastic, system.implicit_strains)),
      before_(system.mesh),
      force_(system.mesh) {
  check(VecCreateMPI(system.mesh.comm, 3 * system.mesh.owned_nodes, PETSC_DETERMINE, right_.out()));
}

/// xⁿ⁺¹ = xⁿ + Δt vⁿ,  M vⁿ⁺¹ = M vⁿ + Δt (f(xⁿ) − C(xⁿ) vⁿ)
StepReport ExplicitEuler::advance(System& system, double dt) {
  std::copy(system.v.owned().begin(), system.v.owned().end(), before_.owned().begin());
  impose(system.prescribed.at(system.time), before_.owned());
  euler_kick(system, solver_, force_, right_.get(), dt);
  return euler_drift(system, before_, dt);
}

}  // namespace evert
