#include "evert/elements/reference_element.hpp"
#include "evert/elements/rest_shape.hpp"
#include "evert/forces/elastic_block.hpp"

#include <array>

namespace evert {

void add_lumped_mass(const ElementView& element, const ElasticCells& cells,
                     std::span<const Vec3d> rest_positions, std::span<double> mass) {
  for (std::size_t first = 0; first < cells.nodes.size(); first += element.nodes()) {
    const auto cell = cells.nodes.subspan(first, element.nodes());
    std::array<double, most_points> volumes{};
    for (std::size_t q = 0; q < element.points(); ++q)
      volumes[q] = point_volume(element, q, rest_jacobian(element, q, cell, rest_positions));
    const auto shares = lumped_volumes(element, volumes);
    for (std::size_t a = 0; a < cell.size(); ++a)
      mass[static_cast<std::size_t>(cell[a])] += cells.density * shares[a];
  }
}

void add_lumped_mass(const ElasticCells& cells, std::span<const Vec3d> rest_positions,
                     std::span<double> mass) {
  add_lumped_mass(reference_element(cells.type), cells, rest_positions, mass);
}

}  // namespace evert
