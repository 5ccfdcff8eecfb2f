#include "evert/elements/rest_shape.hpp"
#include "evert/forces/elastic_block.hpp"

namespace evert {

// Row sums of the consistent mass matrix: m_a = ∫ ρ N_a dX keeps mass and centre of mass, and is positive
// where every N_a is positive at the quadrature points, as in tet4 and hex8.
void add_lumped_mass(const ElasticCells& cells, std::span<const Vec3d> rest_positions,
                     std::span<double> mass) {
  with_reference_element(
      cells.type, [&]<int nodes, int points>(const ReferenceElement<nodes, points>& element) {
        for (std::size_t first = 0; first < cells.nodes.size(); first += nodes) {
          const auto cell = cells.nodes.subspan(first, nodes);
          for (std::size_t q = 0; q < points; ++q) {
            const double volume =
                element.weights[q] * determinant(rest_jacobian(element, q, cell, rest_positions));
            for (std::size_t a = 0; a < nodes; ++a) {
              mass[static_cast<std::size_t>(cell[a])] += cells.density * volume * element.values[q][a];
            }
          }
        }
      });
}

}  // namespace evert
