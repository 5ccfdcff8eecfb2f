#pragma once
#include "evert/math/vec3.hpp"

#include <string>

/// Numbers as the web page of a run reads them.
namespace evert {

/// Little-endian bytes of an unsigned number.
template <class Unsigned>
void append_number(std::string& bytes, Unsigned number) {
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
    bytes.push_back(static_cast<char>(static_cast<unsigned char>(number >> (8 * i))));
}

/// The position with the axis that points up as its second.
[[nodiscard]] inline Vec3d upright(const Vec3d& position, std::size_t up) {
  return {position[(up + 2) % 3], position[up], position[(up + 1) % 3]};
}

}  // namespace evert
