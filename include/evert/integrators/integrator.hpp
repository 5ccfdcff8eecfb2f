#pragma once
#include "evert/integrators/explicit_euler.hpp"
#include "evert/integrators/method.hpp"
#include "evert/integrators/newmark.hpp"
#include "evert/integrators/quasistatic.hpp"
#include "evert/integrators/symplectic_euler.hpp"
#include "evert/integrators/verlet.hpp"

#include <variant>

namespace evert {

/// Every way to advance. Chosen once.
using Integrator = std::variant<Newmark, Verlet, SymplecticEuler, ExplicitEuler, Quasistatic>;

/// c of the scheme: without damping, vibrations of frequency ω are stable up to ωΔt = c. 0 where none is,
/// infinity where nothing vibrates.
[[nodiscard]] double stability_constant_of(IntegrationMethod method);

/// Collective. `quasistatic` is of that method alone.
[[nodiscard]] Integrator make_integrator(IntegrationMethod method, const System& system,
                                         const QuasistaticOptions& quasistatic);

}  // namespace evert
