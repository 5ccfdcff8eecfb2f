#pragma once
#include "evert/integrators/method.hpp"
#include "evert/integrators/newmark.hpp"
#include "evert/integrators/quasistatic.hpp"

#include <variant>

namespace evert {

/// Every way to advance. Chosen once.
using Integrator = std::variant<Newmark, Quasistatic>;

/// Collective. `quasistatic` is of that method alone.
[[nodiscard]] Integrator make_integrator(IntegrationMethod method, const System& system,
                                         const QuasistaticOptions& quasistatic);

}  // namespace evert
