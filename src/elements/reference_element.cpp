#include "evert/elements/reference_element.hpp"

#include "evert/core/error.hpp"

#include <sstream>
#include <string>
#include <vector>

namespace evert {
namespace detail {

void throw_no_reference_element(CellType type, std::span<const CellType> allowed) {
  std::vector<std::string> names;
  for (const CellType known : allowed) names.emplace_back(name_of(known));
  std::ostringstream message;
  message << "cells of type " << name_of(type) << " cannot be simulated; allowed are " << list_of(names);
  throw UserError(message.str());
}

}  // namespace detail

ElementView reference_element(CellType type) {
  return with_reference_element(type, [](const auto& element) { return ElementView(element); });
}

}  // namespace evert
