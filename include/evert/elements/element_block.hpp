#pragma once
#include "evert/core/aligned.hpp"
#include "evert/core/index.hpp"
#include "evert/core/number_array.hpp"
#include "evert/elements/element_view.hpp"
#include "evert/elements/shape_layout.hpp"
#include "evert/math/vec3.hpp"
#include "evert/mesh/mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// Rest data of all cells of one type and one material on a rank, as structure-of-arrays in batches of
/// `lanes` cells.
namespace evert {

/// A range of batches.
struct BatchRange {
  LocalIndex begin = 0;
  LocalIndex end = 0;
};

struct ElementBlock {
  ElementView element;
  int lanes = 1;  ///< cells per batch: the width of the SIMD pack that will read them
  LocalIndex cells = 0;
  BatchRange interior;              ///< batches whose cells touch owned nodes only
  BatchRange boundary;              ///< the others
  AlignedVector<LocalIndex> nodes;  ///< [batch][node of the cell][lane]
  ShapeData shape_data = ShapeData::node_gradients;
  NumberArray shapes;   ///< [batch][point][number][lane], in the order of rest_layout()
  NumberArray volumes;  ///< quadrature weight × det: [batch][point][lane] [m^3]; 0 in padding lanes
  NumberArray fibres;   ///< directions at rest, turned: [batch][point][3][lane]; or empty
  std::vector<LocalIndex>
      cell_of_lane;  ///< [batch][lane]: index into the list given to the maker, −1 for padding

  [[nodiscard]] LocalIndex batches() const { return boundary.end; }
};

/// Batches cells for packs of `lanes`. `nodes`: element.nodes() per cell; cells [0, interior)
/// become the interior batches, the others the boundary ones, each set ordered by batch_order(). Padding
/// lanes have zero shape data and volume and the nodes of the last cell, so that reading and adding to them
/// is safe. Throws UserError when a cell has no positive rest volume, with count and first numbers.
[[nodiscard]] ElementBlock make_element_block(const ElementView& element, std::span<const LocalIndex> nodes,
                                              LocalIndex interior, std::span<const Vec3d> rest_positions,
                                              int lanes, ShapeData shape_data = ShapeData::node_gradients,
                                              Precision precision = Precision::full);

/// Gives every quadrature point of the block the direction of its cell, for materials that have fibres.
/// `directions` are unit vectors in rest coordinates, one a cell, in the order of the list that the block was
/// made from; they are kept as the cells are turned (shape_layout.hpp).
void set_fibres(ElementBlock& block, std::span<const Vec3d> directions, std::span<const Vec3d> rest_positions,
                Precision precision);

/// Cells with a quadrature point at which the rest volume is zero, negative or not finite; ascending.
[[nodiscard]] std::vector<LocalIndex> cells_without_volume(const ElementView& element,
                                                           std::span<const LocalIndex> nodes,
                                                           std::span<const Vec3d> rest_positions);

}  // namespace evert
