#include "evert/elements/element_view.hpp"

namespace evert {

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
