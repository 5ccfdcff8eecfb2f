#include "evert/io/json_text.hpp"

#include "number_text.hpp"
#include <cmath>
#include <cstdio>

namespace evert {
namespace {

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      (result += '\\') += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      std::array<char, 8> code{};
      std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(c));
      result += code.data();
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string indented(const std::string& text) {
  std::string result;
  for (const char c : text) {
    result += c;
    if (c == '\n') result += "  ";
  }
  return result;
}

}  // namespace

JsonValue::JsonValue(std::string_view text) : text_(quoted(text)) {}

JsonValue::JsonValue(double number) : text_(std::isfinite(number) ? shortest(number) : "null") {}

JsonValue JsonValue::object(const std::vector<std::pair<std::string, JsonValue>>& members) {
  JsonValue value;
  value.text_ = "{";
  for (const auto& [key, member] : members) {
    if (value.text_.size() > 1) value.text_ += ',';
    ((value.text_ += "\n  ") += quoted(key) += ": ") += indented(member.text_);
  }
  value.text_ += "\n}";
  return value;
}

JsonValue JsonValue::list(const std::vector<JsonValue>& values) {
  JsonValue value;
  value.text_ = "[";
  for (const auto& element : values) {
    if (value.text_.size() > 1) value.text_ += ", ";
    value.text_ += element.text_;
  }
  value.text_ += ']';
  return value;
}

}  // namespace evert
