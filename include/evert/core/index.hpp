#pragma once
#include <cstdint>

namespace evert {

/// Number of a node or cell in the whole mesh (also with more than 2^31 of them).
using GlobalIndex = std::int64_t;
/// Number of a node or cell on one rank.
using LocalIndex = std::int32_t;

}  // namespace evert
