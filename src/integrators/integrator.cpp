#include "evert/integrators/integrator.hpp"

namespace evert {

Integrator make_integrator(IntegrationMethod method, const System& system,
                           const QuasistaticOptions& quasistatic) {
  switch (method) {
    case IntegrationMethod::quasistatic:
      return Integrator(std::in_place_type<Quasistatic>, system, quasistatic);
    case IntegrationMethod::verlet:
      return Integrator(std::in_place_type<Verlet>, system);
    case IntegrationMethod::symplectic_euler:
      return Integrator(std::in_place_type<SymplecticEuler>, system);
    case IntegrationMethod::explicit_euler:
      return Integrator(std::in_place_type<ExplicitEuler>, system);
    case IntegrationMethod::newmark:
      break;
  }
  return Integrator(std::in_place_type<Newmark>, system);
}

}  // namespace evert
