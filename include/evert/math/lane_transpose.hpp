#pragma once
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

/// Between arrays of structures, x y z in memory per lane, and packs, one lane each: a transposition each
/// way.
namespace evert {

/// Four doubles of one register: x y z and, when read, whatever follows.
using Quad [[gnu::vector_size(32)]] = double;

/// Packs of a multiple of four lanes move whole registers, the others scalars.
template <class T>
inline constexpr bool in_quads = lanes_v<T> % 4 == 0;

/// The x y z of one lane.
template <class T>
using Row = std::conditional_t<in_quads<T>, Quad, Vec3d>;
template <class T>
using Rows = std::array<Row<T>, lanes_v<T>>;

/// May read one double past the three.
template <class T>
EVERT_ALWAYS_INLINE Row<T> load_row(const double* from) {
  if constexpr (in_quads<T>) {
    Quad row;
    std::memcpy(&row, from, sizeof(row));
    return row;
  } else {
    return {from[0], from[1], from[2]};
  }
}

EVERT_ALWAYS_INLINE void store_row(double* to, const Quad& row) {
  using Pair [[gnu::vector_size(16)]] = double;
  const Pair xy = __builtin_shufflevector(row, row, 0, 1);
  std::memcpy(to, &xy, sizeof(xy));
  to[2] = row[2];
}
EVERT_ALWAYS_INLINE void store_row(double* to, const Vec3d& row) {
  for (std::size_t i = 0; i < 3; ++i) to[i] = row[i];
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

/// Eight doubles, four, eight and sixteen floats.
using Octet [[gnu::vector_size(64)]] = double;
using Floats4 [[gnu::vector_size(16)]] = float;
using Floats8 [[gnu::vector_size(32)]] = float;
using Floats16 [[gnu::vector_size(64)]] = float;

template <class T>
using Quads = std::array<Quad, lanes_v<T> / 4>;

EVERT_ALWAYS_INLINE Octet joined(const Quad& low, const Quad& high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
EVERT_ALWAYS_INLINE Floats8 joined(const Floats4& low, const Floats4& high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
EVERT_ALWAYS_INLINE Floats16 joined(const Floats8& low, const Floats8& high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

/// Doubles as the lanes of T, rounded where T holds floats.
template <class T>
EVERT_ALWAYS_INLINE T pack_of(const Quads<T>& quads) {
  if constexpr (std::is_same_v<scalar_t<T>, float>) {
    const auto floats = [&](std::size_t i) { return __builtin_convertvector(quads[i], Floats4); };
    if constexpr (lanes_v<T> == 4) {
      return T(floats(0));
    } else if constexpr (lanes_v<T> == 8) {
      return T(joined(floats(0), floats(1)));
    } else {
      return T(joined(joined(floats(0), floats(1)), joined(floats(2), floats(3))));
    }
  } else if constexpr (lanes_v<T> == 4) {
    return T(quads[0]);
  } else {
    return T(joined(quads[0], quads[1]));
  }
}

EVERT_ALWAYS_INLINE Quad doubles(const Floats4& floats) { return __builtin_convertvector(floats, Quad); }
EVERT_ALWAYS_INLINE std::array<Quad, 2> doubles(const Floats8& all) {
  return {doubles(Floats4(__builtin_shufflevector(all, all, 0, 1, 2, 3))),
          doubles(Floats4(__builtin_shufflevector(all, all, 4, 5, 6, 7)))};
}

/// The inverse of pack_of.
template <class T>
EVERT_ALWAYS_INLINE Quads<T> quads_of(const T& pack) {
  if constexpr (std::is_same_v<scalar_t<T>, float>) {
    if constexpr (lanes_v<T> == 4) {
      return {doubles(pack.vector())};
    } else if constexpr (lanes_v<T> == 8) {
      return doubles(pack.vector());
    } else {
      const auto all = pack.vector();
      const auto low = doubles(Floats8(__builtin_shufflevector(all, all, 0, 1, 2, 3, 4, 5, 6, 7)));
      const auto high = doubles(Floats8(__builtin_shufflevector(all, all, 8, 9, 10, 11, 12, 13, 14, 15)));
      return {low[0], low[1], high[0], high[1]};
    }
  } else if constexpr (lanes_v<T> == 4) {
    return {pack.vector()};
  } else {
    const auto all = pack.vector();
    return {__builtin_shufflevector(all, all, 0, 1, 2, 3), __builtin_shufflevector(all, all, 4, 5, 6, 7)};
  }
}

}  // namespace detail

/// x, y and z over the lanes.
template <class T>
EVERT_ALWAYS_INLINE Vec3<T> components(const Rows<T>& rows) {
  if constexpr (in_quads<T>) {
    detail::Quads<T> x, y, z;
    for (std::size_t i = 0; i < lanes_v<T> / 4; ++i) {
      const auto c = detail::columns_of(rows[4 * i], rows[4 * i + 1], rows[4 * i + 2], rows[4 * i + 3]);
      x[i] = c.x;
      y[i] = c.y;
      z[i] = c.z;
    }
    return {detail::pack_of<T>(x), detail::pack_of<T>(y), detail::pack_of<T>(z)};
  } else {
    const auto along = [&](std::size_t i) {
      return generate<T>([&](std::size_t l) { return static_cast<scalar_t<T>>(rows[l][i]); });
    };
    return {along(0), along(1), along(2)};
  }
}

/// The inverse of components().
template <class T>
EVERT_ALWAYS_INLINE Rows<T> rows_of_lanes(const Vec3<T>& value) {
  Rows<T> rows;
  if constexpr (in_quads<T>) {
    const auto x = detail::quads_of(value[0]), y = detail::quads_of(value[1]), z = detail::quads_of(value[2]);
    for (std::size_t i = 0; i < lanes_v<T> / 4; ++i) {
      const auto four = detail::rows_of({x[i], y[i], z[i]});
      for (std::size_t l = 0; l < 4; ++l) rows[4 * i + l] = four[l];
    }
  } else {
    for (std::size_t l = 0; l < lanes_v<T>; ++l)
      rows[l] = {lane(value[0], l), lane(value[1], l), lane(value[2], l)};
  }
  return rows;
}

}  // namespace evert
