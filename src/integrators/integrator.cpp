#include "evert/integrators/integrator.hpp"

namespace evert {

Integrator make_integrator(IntegrationMethod method, const System& system,
                           const QuasistaticOptions& quasistatic) {
  if (method == IntegrationMethod::quasistatic)
    return Integrator(std::in_place_type<Quasistatic>, system, quasistatic);
  return Integrator(std::in_place_type<Newmark>, system);
}

}  // namespace evert
