#pragma once
#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"

#include <cmath>
#include <string>

namespace evert {

/// Throws UserError unless `length`, called `name`, is positive and finite.
inline void require_positive(double length, const std::string& name) {
  if (!(length > 0) || !std::isfinite(length))
    throw UserError(name + formatted(" is %g, but must be a positive finite length", length));
}

}  // namespace evert
