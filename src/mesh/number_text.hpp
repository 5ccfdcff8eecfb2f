#pragma once
#include <array>
#include <charconv>
#include <string>

namespace evert {

/// The shortest text that reads back as exactly this number.
template <class Number>
[[nodiscard]] std::string shortest(Number value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace evert
