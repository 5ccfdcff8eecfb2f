#pragma once
#include "evert/filter/modal_filter_options.hpp"
#include "evert/filter/selection.hpp"

#include <vector>

/// `filter.time_step: auto`: whether to filter, and for which step.  docs/modal-filter.md
namespace evert {

/// What a filtered tetrahedron costs in a step, in units of an unfiltered one of the same model. Measured by
/// `evert bench kernels`; docs/modal-filter.md has the table.
[[nodiscard]] double relative_cost(const Material& material);

/// A step that was looked at.
struct FilterCandidate {
  double multiple = 0;       ///< of the step that the body takes without a filter
  double time_step = 0;      ///< [s]
  GlobalIndex filtered = 0;  ///< cells, by `paper` or, for the other selections, `spare_mass`
  double softened = 0;       ///< the largest share of the mass of any region that is in filtered cells
  double gain = 0;           ///< time for a simulated second without the filter over that with it
  bool within_reach = true;  ///< false: every cell of a region would have to be softened
  /// Compliant cells keep all of their stiffness.
  [[nodiscard]] bool softens_too_much(const ModalFilterOptions& options) const {
    return options.constraints != FilterConstraints::compliant && softened > options.most_softened;
  }
  [[nodiscard]] bool worthwhile(const ModalFilterOptions& options) const {
    return within_reach && gain > 1 && !softens_too_much(options);
  }
};

struct AutomaticStep {
  double own_step = 0;                        ///< [s] without a filter, at rest
  std::vector<FilterCandidate> candidates{};  ///< by ascending step
  double time_step = 0;  ///< [s] filtered for: that with the largest gain; infinity: none
};

/// Collective. Of a body without filtered cells. A fixed step of the integrator is filtered for whatever the
/// gain, where the body does not take it by itself.
[[nodiscard]] AutomaticStep choose_time_step(const FilterProblem& problem, const ModalFilterOptions& options);

}  // namespace evert
