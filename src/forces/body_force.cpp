#include "evert/forces/body_force.hpp"

#include "evert/elements/reference_element.hpp"
#include "evert/elements/rest_shape.hpp"

namespace evert {
namespace {

void add_cell(const ElementView& element, std::span<const LocalIndex> cell, std::span<const Vec3d> rest,
              const BodyForce& force, double time, std::span<double> f) {
  for (std::size_t q = 0; q < element.points(); ++q) {
    Vec3d position{};
    for (std::size_t a = 0; a < cell.size(); ++a)
      position += element.value(q, a) * rest[static_cast<std::size_t>(cell[a])];
    const double volume = point_volume(element, q, rest_jacobian(element, q, cell, rest));
    const Vec3d at_point = volume * force(position, time);
    for (std::size_t a = 0; a < cell.size(); ++a)
      for (std::size_t k = 0; k < 3; ++k)
        f[3 * static_cast<std::size_t>(cell[a]) + k] += element.value(q, a) * at_point[k];
  }
}

}  // namespace

void add_body_force(const DistributedMesh& mesh, const BodyForce& force, double time, NodeField& f) {
  for (const auto& cells : mesh.cells) {
    const ElementView element = reference_element(cells.type);
    for (std::size_t first = 0; first < cells.nodes.size(); first += element.nodes())
      add_cell(element, std::span(cells.nodes).subspan(first, element.nodes()), mesh.rest_positions, force,
               time, f.local());
  }
}

}  // namespace evert
