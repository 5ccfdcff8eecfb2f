#pragma once
#include <array>
#include <charconv>
#include <string>

namespace evert {

/// The shortest text that reads back as the same number.
[[nodiscard]] inline std::string shortest(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace evert
