#pragma once
#include "evert/filter/selection.hpp"

#include <vector>

namespace evert {

/// Collective. The selection `adaptive`, see select(). Cells that are not `changed` begin as `clamps` has
/// them.
LocalIndex select_adaptive(const FilterProblem& problem, double limit, const std::vector<bool>& changed,
                           CellClamps& clamps);

}  // namespace evert
