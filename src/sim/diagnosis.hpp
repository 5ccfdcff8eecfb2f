#pragma once
#include "evert/filter/modal_filter.hpp"
#include "evert/integrators/integrator.hpp"
#include "evert/sim/soundness.hpp"

#include <string>

/// Why a run broke down, and what to try. Slow: for the end of a run.
namespace evert {

struct BrokenStep {
  double dt = 0;       ///< [s]; 0: the state is that of a start
  bool fixed = false;  ///< the scene names it
};

/// Collective. "the motion has blown up ..., node 17 of element 40 of 'ball' ...".
[[nodiscard]] std::string what_happened(const System& system, const Soundness::Findings& found,
                                        const Soundness& soundness);

/// Collective. "; the step of 0.2 s is 12 times the longest ...: try an integrator.time_step of ...", where
/// that is so, else "". What is stable is asked at rest: `system` is left there.
[[nodiscard]] std::string blame_of_step(System& system, const Integrator& integrator,
                                        const ModalFilter* filter, const BrokenStep& step);

/// Collective. The same, or what else there is to try.
[[nodiscard]] std::string what_to_try(System& system, const Integrator& integrator, const ModalFilter* filter,
                                      const BrokenStep& step);

}  // namespace evert
