#include "evert/elements/rest_shape.hpp"
#include "evert/forces/elastic_block.hpp"

namespace evert {

void add_lumped_mass(const ElasticCells& cells, std::span<const Vec3d> rest_positions,
                     std::span<double> mass) {
  with_reference_element(
      cells.type, [&]<int nodes, int points>(const ReferenceElement<nodes, points>& element) {
        for (std::size_t first = 0; first < cells.nodes.size(); first += nodes) {
          const auto cell = cells.nodes.subspan(first, nodes);
          std::array<double, points> volumes;
          for (std::size_t q = 0; q < points; ++q)
            volumes[q] = element.weights[q] * determinant(rest_jacobian(element, q, cell, rest_positions));
          const auto shares = lumped_volumes(element, volumes);
          for (std::size_t a = 0; a < nodes; ++a)
            mass[static_cast<std::size_t>(cell[a])] += cells.density * shares[a];
        }
      });
}

}  // namespace evert
