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

std::array<double, most_nodes> lumped_volumes(const ElementView& element, std::span<const double> volumes) {
  std::array<double, most_nodes> rows{}, diagonal{};
  double volume = 0, trace = 0;
  bool positive = true;
  for (std::size_t q = 0; q < element.points(); ++q) {
    volume += volumes[q];
    for (std::size_t a = 0; a < element.nodes(); ++a) {
      const double value = element.value(q, a);
      positive = positive && value > 0;
      rows[a] += value * volumes[q];
      diagonal[a] += value * value * volumes[q];
      trace += value * value * volumes[q];
    }
  }
  if (positive) return rows;
  for (double& share : diagonal) share *= volume / trace;
  return diagonal;
}

}  // namespace evert
