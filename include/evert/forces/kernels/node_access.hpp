#pragma once
#include "evert/core/index.hpp"
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>

/// Between nodal arrays (x y z per node) and packs (one lane per cell): a transposition each way.
namespace evert::kernels {

/// Four doubles of one register: x y z of a node and, when read, whatever follows.
using Quad [[gnu::vector_size(32)]] = double;

/// Packs of four lanes or more move nodes by whole registers, the others by scalars.
template <class T>
inline constexpr bool in_quads = lanes_v<T> == 4 || lanes_v<T> == 8;

/// The value of one node.
template <class T>
using NodeRow = std::conditional_t<in_quads<T>, Quad, Vec3d>;

/// The values of the same node of each cell in a batch.
template <class T>
using NodeRows = std::array<NodeRow<T>, lanes_v<T>>;

template <class T>
EVERT_ALWAYS_INLINE NodeRow<T> load_row(const double* from) {
  if constexpr (in_quads<T>) {
    Quad row;
    std::memcpy(&row, from, sizeof(row));
    return row;
  } else {
    return {from[0], from[1], from[2]};
  }
}

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

/// Adds a row per lane to the node of that lane, one lane after the other: lanes may share a node. `stride`
/// numbers lie between nodes.
template <class T, int stride = 3>
EVERT_ALWAYS_INLINE void add_rows(double* values, const LocalIndex* nodes, const NodeRows<T>& rows) {
  for (std::size_t l = 0; l < lanes_v<T>; ++l) {
    add_row(values + stride * static_cast<std::ptrdiff_t>(nodes[l]), rows[l]);
  }
}

namespace detail {

struct QuadColumns {
  Quad x, y, z;
};

EVERT_ALWAYS_INLINE QuadColumns columns_of(const Quad& r0, const Quad& r1, const Quad& r2, const Quad& r3) {
  const Quad xz01 = __builtin_shufflevector(r0, r1, 0, 4, 2, 6);
  const Quad xz23 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6);
  const Quad y_01 = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);
  const Quad y_23 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
  return {__builtin_shufflevector(xz01, xz23, 0, 1, 4, 5), __builtin_shufflevector(y_01, y_23, 0, 1, 4, 5),
          __builtin_shufflevector(xz01, xz23, 2, 3, 6, 7)};
}

/// The fourth number of each row is of no meaning.
EVERT_ALWAYS_INLINE std::array<Quad, 4> rows_of(const QuadColumns& c) {
  const Quad xy02 = __builtin_shufflevector(c.x, c.y, 0, 4, 2, 6);
  const Quad xy13 = __builtin_shufflevector(c.x, c.y, 1, 5, 3, 7);
  const Quad z_02 = __builtin_shufflevector(c.z, c.z, 0, 4, 2, 6);
  const Quad z_13 = __builtin_shufflevector(c.z, c.z, 1, 5, 3, 7);
  return {__builtin_shufflevector(xy02, z_02, 0, 1, 4, 5), __builtin_shufflevector(xy13, z_13, 0, 1, 4, 5),
          __builtin_shufflevector(xy02, z_02, 2, 3, 6, 7), __builtin_shufflevector(xy13, z_13, 2, 3, 6, 7)};
}

/// Eight doubles of one register.
using Octet [[gnu::vector_size(64)]] = double;

template <class T>
EVERT_ALWAYS_INLINE T pack_of(const Quad& all) {
  return T(std::bit_cast<std::remove_cvref_t<decltype(T().simd())>>(all));
}
template <class T>
EVERT_ALWAYS_INLINE T pack_of(const Quad& low, const Quad& high) {
  const Octet all = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
  return T(std::bit_cast<std::remove_cvref_t<decltype(T().simd())>>(all));
}

EVERT_ALWAYS_INLINE Quad low_half(const Octet& x) { return __builtin_shufflevector(x, x, 0, 1, 2, 3); }
EVERT_ALWAYS_INLINE Quad high_half(const Octet& x) { return __builtin_shufflevector(x, x, 4, 5, 6, 7); }

}  // namespace detail

/// x, y and z over the lanes.
template <class T>
EVERT_ALWAYS_INLINE Vec3<T> components(const NodeRows<T>& rows) {
  if constexpr (lanes_v<T> == 4) {
    const auto c = detail::columns_of(rows[0], rows[1], rows[2], rows[3]);
    return {detail::pack_of<T>(c.x), detail::pack_of<T>(c.y), detail::pack_of<T>(c.z)};
  } else if constexpr (lanes_v<T> == 8) {
    const auto low = detail::columns_of(rows[0], rows[1], rows[2], rows[3]);
    const auto high = detail::columns_of(rows[4], rows[5], rows[6], rows[7]);
    return {detail::pack_of<T>(low.x, high.x), detail::pack_of<T>(low.y, high.y),
            detail::pack_of<T>(low.z, high.z)};
  } else {
    const auto along = [&](std::size_t i) { return generate<T>([&](std::size_t l) { return rows[l][i]; }); };
    return {along(0), along(1), along(2)};
  }
}

/// The inverse of components().
template <class T>
EVERT_ALWAYS_INLINE NodeRows<T> rows_of_lanes(const Vec3<T>& value) {
  if constexpr (lanes_v<T> == 4) {
    const auto quad = [&](std::size_t i) { return std::bit_cast<Quad>(value[i].simd()); };
    return detail::rows_of({quad(0), quad(1), quad(2)});
  } else if constexpr (lanes_v<T> == 8) {
    using detail::high_half, detail::low_half, detail::Octet;
    const auto octet = [&](std::size_t i) { return std::bit_cast<Octet>(value[i].simd()); };
    const Octet x = octet(0), y = octet(1), z = octet(2);
    const auto low = detail::rows_of({low_half(x), low_half(y), low_half(z)});
    const auto high = detail::rows_of({high_half(x), high_half(y), high_half(z)});
    return {low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]};
  } else {
    NodeRows<T> rows;
    for (std::size_t l = 0; l < lanes_v<T>; ++l) {
      rows[l] = {lane(value[0], l), lane(value[1], l), lane(value[2], l)};
    }
    return rows;
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
