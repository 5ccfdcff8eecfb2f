#pragma once
#include "evert/elements/reference_element.hpp"
#include "evert/elements/rest_shape.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <span>

/// Integrals over the cells of a rank, for the errors of solutions.
namespace evert::test {

/// What a solution is at a point of quadrature.
struct QuadraturePoint {
  Vec3d rest{};                  ///< [m]
  Vec3d position{};              ///< [m]
  Mat3d deformation_gradient{};  ///< ∂x/∂X
  double volume = 0;             ///< |∂X/∂ξ| W [m^3]
};

template <int nodes, int points, class Visit>
void visit_cell(const ReferenceElement<nodes, points>& element, std::span<const LocalIndex> cell,
                std::span<const Vec3d> rest_positions, std::span<const double> x, Visit&& visit) {
  for (std::size_t q = 0; q < points; ++q) {
    const Mat3d jacobian = rest_jacobian(element, q, cell, rest_positions);
    const Mat3d to_reference = inverse(jacobian);
    QuadraturePoint point{.volume = element.weights[q] * determinant(jacobian)};
    for (std::size_t a = 0; a < nodes; ++a) {
      const auto node = static_cast<std::size_t>(cell[a]);
      const Vec3d position{x[3 * node], x[3 * node + 1], x[3 * node + 2]};
      point.rest += element.values[q][a] * rest_positions[node];
      point.position += element.values[q][a] * position;
      point.deformation_gradient += outer(position, transpose_times(to_reference, element.gradients[q][a]));
    }
    visit(point);
  }
}

/// visit(QuadraturePoint) for every point of this rank's cells; `x` per local node, ghosts up to date.
template <class Visit>
void for_each_point(const DistributedMesh& mesh, std::span<const double> x, Visit&& visit) {
  for (const auto& cells : mesh.cells)
    with_reference_element(cells.type, [&](const auto& element) {
      const auto per_cell = static_cast<std::size_t>(element.nodes);
      for (std::size_t first = 0; first < cells.nodes.size(); first += per_cell)
        visit_cell(element, std::span(cells.nodes).subspan(first, per_cell), mesh.rest_positions, x, visit);
    });
}

}  // namespace evert::test
