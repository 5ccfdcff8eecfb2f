#include "evert/elements/element_block.hpp"

#include "evert/core/error.hpp"
#include "evert/elements/batching.hpp"
#include "evert/elements/rest_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace evert {
namespace {

/// Rounding may leave a tetrahedron of identical nodes with a volume of the size of its last bits, so zero is
/// not asked for exactly; subnormal volumes have no finite inverse.
bool has_volume(double jacobian_determinant) {
  return std::isnormal(jacobian_determinant) && jacobian_determinant > 0;
}

class CellList {
 public:
  CellList(std::span<const LocalIndex> nodes, std::size_t per_cell) : nodes_(nodes), per_cell_(per_cell) {}
  [[nodiscard]] LocalIndex size() const { return static_cast<LocalIndex>(nodes_.size() / per_cell_); }
  [[nodiscard]] std::span<const LocalIndex> operator[](LocalIndex cell) const {
    return nodes_.subspan(static_cast<std::size_t>(cell) * per_cell_, per_cell_);
  }

 private:
  std::span<const LocalIndex> nodes_;
  std::size_t per_cell_;
};

[[noreturn]] void throw_without_volume(CellType type, std::span<const LocalIndex> bad, LocalIndex total) {
  std::ostringstream message;
  message << bad.size() << " of " << total << " " << name_of(type)
          << " cells have zero or negative rest volume (first:";
  for (const LocalIndex cell : bad.first(std::min<std::size_t>(bad.size(), 5))) message << " " << cell;
  message << "); every cell needs a positive one, and `evert mesh convert` can reorder their nodes";
  throw UserError(message.str());
}

/// Writes the numbers of one cell into its lane of a block.
class LaneWriter {
 public:
  explicit LaneWriter(ElementBlock& block)
      : element_(block.element),
        block_(block),
        layout_(rest_layout(block.shape_data, element_.nodes(), element_.points())) {}

  void write_nodes(std::size_t slot, std::span<const LocalIndex> cell) {
    for (std::size_t a = 0; a < cell.size(); ++a) block_.nodes[at(slot, cell.size(), a)] = cell[a];
  }

  void write_rest_shape(std::size_t slot, std::span<const LocalIndex> cell,
                        std::span<const Vec3d> rest_positions) {
    for (std::size_t q = 0; q < element_.points(); ++q) {
      const Mat3d jacobian = rest_jacobian(element_, q, cell, rest_positions);
      block_.volumes.set(at(slot, element_.points(), q), point_volume(element_, q, jacobian));
      const RestVectors vectors(element_, block_.shape_data, q, jacobian);
      const Mat3d frame = vectors.frame();
      for (std::size_t j = 0; j < layout_.vectors; ++j)
        write_shape(slot, q, j, transpose_times(frame, vectors[j]));
    }
  }

 private:
  /// Vector number `j` of point `q`.
  void write_shape(std::size_t slot, std::size_t q, std::size_t j, const Vec3d& vector) {
    const std::size_t begin = q * layout_.numbers() + layout_.begin(j);
    for (std::size_t i = 0; i < layout_.components(j); ++i)
      block_.shapes.set(at(slot, element_.points() * layout_.numbers(), begin + i), vector[i]);
  }

  /// Position of number `i` of the `count` a cell has, in an array [batch][count][lane].
  [[nodiscard]] std::size_t at(std::size_t slot, std::size_t count, std::size_t i) const {
    const auto lanes = static_cast<std::size_t>(block_.lanes);
    return (slot / lanes * count + i) * lanes + slot % lanes;
  }

  const ElementView& element_;
  ElementBlock& block_;
  ShapeLayout layout_;
};

/// Cells in the order of their lanes, −1 for padding: each of the two sets fills whole batches.
std::vector<LocalIndex> lanes_of_cells(std::span<const LocalIndex> nodes, int per_cell, LocalIndex cells,
                                       LocalIndex interior, int lanes) {
  std::vector<LocalIndex> all(static_cast<std::size_t>(cells));
  std::iota(all.begin(), all.end(), 0);
  const std::span<const LocalIndex> inner = std::span(all).first(static_cast<std::size_t>(interior));
  const std::span<const LocalIndex> outer_cells = std::span(all).subspan(static_cast<std::size_t>(interior));
  std::vector<LocalIndex> cell_of_lane;
  for (const auto set : {inner, outer_cells}) {
    const std::vector<LocalIndex> order = batch_order(set, nodes, per_cell, lanes);
    cell_of_lane.insert(cell_of_lane.end(), order.begin(), order.end());
    while (cell_of_lane.size() % static_cast<std::size_t>(lanes) != 0) cell_of_lane.push_back(-1);
  }
  return cell_of_lane;
}

}  // namespace

std::vector<LocalIndex> cells_without_volume(const ElementView& element, std::span<const LocalIndex> nodes,
                                             std::span<const Vec3d> rest_positions) {
  const CellList cells(nodes, element.nodes());
  std::vector<LocalIndex> bad;
  for (LocalIndex cell = 0; cell < cells.size(); ++cell) {
    for (std::size_t q = 0; q < element.points(); ++q) {
      if (has_volume(determinant(rest_jacobian(element, q, cells[cell], rest_positions)))) continue;
      bad.push_back(cell);
      break;
    }
  }
  return bad;
}

ElementBlock make_element_block(const ElementView& element, std::span<const LocalIndex> nodes,
                                LocalIndex interior, std::span<const Vec3d> rest_positions, int lanes,
                                ShapeData shape_data, Precision precision) {
  const CellList cells(nodes, element.nodes());
  if (const auto bad = cells_without_volume(element, nodes, rest_positions); !bad.empty()) {
    throw_without_volume(element.type(), bad, cells.size());
  }

  ElementBlock block;
  block.element = element;
  block.lanes = lanes;
  block.shape_data = shape_data;
  block.cells = cells.size();
  block.cell_of_lane =
      lanes_of_cells(nodes, static_cast<int>(element.nodes()), cells.size(), interior, lanes);
  block.interior = {0, (interior + lanes - 1) / lanes};
  block.boundary = {block.interior.end, static_cast<LocalIndex>(block.cell_of_lane.size()) / lanes};

  const std::size_t slots = block.cell_of_lane.size();
  block.nodes.resize(slots * element.nodes());
  block.shapes = {precision, slots * element.points() *
                                 rest_layout(shape_data, element.nodes(), element.points()).numbers()};
  block.volumes = {precision, slots * element.points()};
  LaneWriter writer(block);
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const LocalIndex cell = block.cell_of_lane[slot];
    writer.write_nodes(slot, cells[cell >= 0 ? cell : cells.size() - 1]);
    if (cell >= 0) writer.write_rest_shape(slot, cells[cell], rest_positions);
  }
  return block;
}

}  // namespace evert
