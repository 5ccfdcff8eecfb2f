#include "evert/integrators/integrator.hpp"

namespace evert {

double stability_constant_of(IntegrationMethod method) {
  switch (method) {
    case IntegrationMethod::quasistatic:
      return Quasistatic::stability_constant;
    case IntegrationMethod::verlet:
      return Verlet::stability_constant;
    case IntegrationMethod::symplectic_euler:
      return SymplecticEuler::stability_constant;
    case IntegrationMethod::explicit_euler:
      return ExplicitEuler::stability_constant;
    case IntegrationMethod::newmark:
      break;
  }
  return Newmark::stability_constant;
}

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
