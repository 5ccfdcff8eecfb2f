#pragma once
#include "evert/io/hdf5_file.hpp"
#include "evert/io/natural_order.hpp"

#include <cstdint>

namespace evert {

/// Bytes that a file may need besides the values of its tables.
inline constexpr std::int64_t metadata_allowance = 64 << 10;

/// The rows of a table in natural order that this rank writes or reads.
[[nodiscard]] inline RowRange rows_of(const NaturalOrder& order) {
  return {order.first(), static_cast<GlobalIndex>(order.slice_size())};
}

}  // namespace evert
