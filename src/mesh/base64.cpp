#include "base64.hpp"

#include <array>
#include <cstdint>

namespace evert {
namespace {

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::int8_t, 256> make_values() {
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < alphabet.size(); ++i)
    values[static_cast<unsigned char>(alphabet[i])] = static_cast<std::int8_t>(i);
  return values;
}
constexpr auto values = make_values();

constexpr bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

}  // namespace

std::string to_base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto group = bytes.substr(i, 3);
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 3; ++b)
      bits = bits << 8U | (b < group.size() ? static_cast<unsigned char>(group[b]) : 0U);
    for (std::size_t c = 0; c < 4; ++c)
      text += c <= group.size() ? alphabet[bits >> (6 * (3 - c)) & 63U] : '=';
  }
  return text;
}

std::optional<std::string> from_base64(std::string_view text, std::size_t size) {
  std::string bytes;
  std::uint32_t bits = 0;
  int digits = 0;
  int padding = 0;
  for (const char c : text) {
    if (bytes.size() >= size) break;
    if (is_blank(c)) continue;
    const auto value = values[static_cast<unsigned char>(c)];
    if (c == '=' && digits >= 2) {
      ++padding;
    } else if (value < 0 || padding > 0) {
      return {};
    }
    bits = bits << 6U | static_cast<std::uint32_t>(value < 0 ? 0 : value);
    if (++digits < 4) continue;
    for (int b = 0; b < 3 - padding; ++b) bytes += static_cast<char>(bits >> (8 * (2 - b)) & 255U);
    bits = 0;
    digits = padding = 0;
  }
  if (bytes.size() > size) bytes.resize(size);
  return bytes;
}

}  // namespace evert
