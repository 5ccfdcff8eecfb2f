#pragma once
#include <cstddef>
#include <cstdio>
#include <string>

namespace evert {

/// printf into a string of whatever length.
template <class... Values>
[[nodiscard]] std::string formatted(const char* format, Values... values) {
  const int length = std::snprintf(nullptr, 0, format, values...);
  std::string text(static_cast<std::size_t>(length > 0 ? length : 0), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

}  // namespace evert
