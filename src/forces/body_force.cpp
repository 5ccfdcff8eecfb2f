#include "evert/forces/body_force.hpp"

#include "evert/elements/rest_shape.hpp"

namespace evert {
namespace {

template <int nodes, int points>
void add_cell(const ReferenceElement<nodes, points>& element, std::span<const LocalIndex> cell,
              std::span<const Vec3d> rest, const BodyForce& force, double time, std::span<double> f) {
  for (std::size_t q = 0; q < points; ++q) {
    Vec3d position{};
    for (std::size_t a = 0; a < nodes; ++a)
      position += element.values[q][a] * rest[static_cast<std::size_t>(cell[a])];
    const double volume = element.weights[q] * determinant(rest_jacobian(element, q, cell, rest));
    const Vec3d at_point = volume * force(position, time);
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t k = 0; k < 3; ++k)
        f[3 * static_cast<std::size_t>(cell[a]) + k] += element.values[q][a] * at_point[k];
  }
}

}  // namespace

void add_body_force(const DistributedMesh& mesh, const BodyForce& force, double time, NodeField& f) {
  for (const auto& cells : mesh.cells)
    with_reference_element(cells.type, [&](const auto& element) {
      const auto per_cell = static_cast<std::size_t>(element.nodes);
      for (std::size_t first = 0; first < cells.nodes.size(); first += per_cell)
        add_cell(element, std::span(cells.nodes).subspan(first, per_cell), mesh.rest_positions, force, time,
                 f.local());
    });
}

}  // namespace evert
