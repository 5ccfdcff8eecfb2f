#pragma once
#include "evert/core/index.hpp"
#include "evert/math/lane_transpose.hpp"

#include <array>
#include <cstddef>
#include <cstring>

/// Between nodal arrays (x y z per node) and packs (one lane per cell). Nodal values are doubles; a pack of
/// floats is rounded to after differences were taken, and added in double.
namespace evert::kernels {

/// The values of the same node of each cell in a batch.
template <class T>
using NodeRows = Rows<T>;

/// `nodes` has one local number per lane. Reads one double past the last node (see ElasticBlock).
template <class T>
EVERT_ALWAYS_INLINE NodeRows<T> load_rows(const double* values, const LocalIndex* nodes) {
  NodeRows<T> rows;
  for (std::size_t l = 0; l < lanes_v<T>; ++l) {
    rows[l] = load_row<T>(values + 3 * static_cast<std::ptrdiff_t>(nodes[l]));
  }
  return rows;
}

EVERT_ALWAYS_INLINE void add_row(double* to, const Quad& row) {
  using Pair [[gnu::vector_size(16)]] = double;
  Pair xy;
  std::memcpy(&xy, to, sizeof(xy));
  xy += __builtin_shufflevector(row, row, 0, 1);
  std::memcpy(to, &xy, sizeof(xy));
  to[2] += row[2];
}

EVERT_ALWAYS_INLINE void add_row(double* to, const Vec3d& row) {
  to[0] += row[0];
  to[1] += row[1];
  to[2] += row[2];
}

/// Adds a row per lane to the node of that lane, one lane after the other: lanes may share a node.
template <class T>
EVERT_ALWAYS_INLINE void add_rows(double* values, const LocalIndex* nodes, const NodeRows<T>& rows) {
  for (std::size_t l = 0; l < lanes_v<T>; ++l) {
    add_row(values + 3 * static_cast<std::ptrdiff_t>(nodes[l]), rows[l]);
  }
}

/// Differences to the first node: D_s of paper A, section 3. One Vec3 per other node.
template <class T, int nodes>
using Edges = std::array<Vec3<T>, nodes - 1>;

/// `cell_nodes`: [node][lane].
template <class T, int nodes>
EVERT_ALWAYS_INLINE Edges<T, nodes> gather_edges(const double* values, const LocalIndex* cell_nodes) {
  const NodeRows<T> first = load_rows<T>(values, cell_nodes);
  Edges<T, nodes> edges;
  for (std::size_t a = 1; a < nodes; ++a) {
    NodeRows<T> rows = load_rows<T>(values, cell_nodes + a * lanes_v<T>);
    for (std::size_t l = 0; l < lanes_v<T>; ++l) rows[l] = rows[l] - first[l];
    edges[a - 1] = components<T>(rows);
  }
  return edges;
}

/// Adds one Vec3 per node but the first, and minus their sum to the first: what acts inside a cell has no
/// resultant.
template <class T, int nodes>
EVERT_ALWAYS_INLINE void scatter_balanced(const Edges<T, nodes>& of_nodes, double* values,
                                          const LocalIndex* cell_nodes) {
  NodeRows<T> balance{};
  for (std::size_t a = 1; a < nodes; ++a) {
    const NodeRows<T> rows = rows_of_lanes<T>(of_nodes[a - 1]);
    for (std::size_t l = 0; l < lanes_v<T>; ++l) balance[l] = balance[l] - rows[l];
    add_rows<T>(values, cell_nodes + a * lanes_v<T>, rows);
  }
  add_rows<T>(values, cell_nodes, balance);
}

}  // namespace evert::kernels
