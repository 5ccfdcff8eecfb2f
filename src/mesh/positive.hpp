#pragma once
#include "evert/core/error.hpp"

#include "number_text.hpp"
#include <cmath>
#include <string>
#include <string_view>

namespace evert {

/// Throws UserError unless `length`, called `name`, is positive and finite.
inline void require_positive(double length, std::string_view name) {
  if (!(length > 0) || !std::isfinite(length))
    throw UserError(std::string(name) + " is " + shortest(length) + ", but must be a positive finite length");
}

}  // namespace evert
