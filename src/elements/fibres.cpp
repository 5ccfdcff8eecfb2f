#include "evert/core/error.hpp"
#include "evert/elements/element_block.hpp"
#include "evert/elements/rest_shape.hpp"

#include <array>
#include <string>

namespace evert {
namespace {

/// Q of the cell in lane number `slot` of all lanes: how it is turned (shape_layout.hpp).
Mat3d frame_of(const ElementBlock& block, std::size_t slot, std::span<const Vec3d> rest_positions) {
  const auto lanes = static_cast<std::size_t>(block.lanes);
  const std::size_t nodes = block.element.nodes();
  std::array<LocalIndex, most_nodes> cell{};
  for (std::size_t a = 0; a < nodes; ++a)
    cell[a] = block.nodes[(slot / lanes * nodes + a) * lanes + slot % lanes];
  const Mat3d jacobian = rest_jacobian(block.element, 0, std::span(cell).first(nodes), rest_positions);
  return RestVectors(block.element, block.shape_data, 0, jacobian).frame();
}

}  // namespace

void set_fibres(ElementBlock& block, std::span<const Vec3d> directions, std::span<const Vec3d> rest_positions,
                Precision precision) {
  EVERT_ASSERT(directions.size() == static_cast<std::size_t>(block.cells), std::to_string(directions.size()));
  const std::size_t slots = block.cell_of_lane.size();
  const std::size_t points = block.element.points();
  const auto lanes = static_cast<std::size_t>(block.lanes);
  block.fibres = {precision, 3 * points * slots};
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const LocalIndex cell = block.cell_of_lane[slot];
    if (cell < 0) continue;
    const Vec3d direction =
        transpose_times(frame_of(block, slot, rest_positions), directions[static_cast<std::size_t>(cell)]);
    for (std::size_t q = 0; q < points; ++q) {
      for (std::size_t i = 0; i < 3; ++i)
        block.fibres.set(((slot / lanes * points + q) * 3 + i) * lanes + slot % lanes, direction[i]);
    }
  }
}

}  // namespace evert
