#pragma once
#include <cstddef>

namespace evert {

/// Bytes that this rank has allocated and not freed: of the heap, and of large arrays beside it
/// (allocate_aligned).
[[nodiscard]] std::size_t memory_in_use();

}  // namespace evert
