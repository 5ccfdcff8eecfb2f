#pragma once
#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// As much JSON as a report needs.
namespace evert {

/// Text of a JSON value.
class JsonValue {
 public:
  JsonValue(std::string_view text);  // NOLINT: values convert, so that objects read like JSON
  JsonValue(const std::string& text) : JsonValue(std::string_view(text)) {}  // NOLINT
  JsonValue(const char* text) : JsonValue(std::string_view(text)) {}         // NOLINT
  JsonValue(double number);                                                  // NOLINT: null unless finite
  JsonValue(std::integral auto number) : text_(std::to_string(number)) {}    // NOLINT

  /// An object with one member a line.
  [[nodiscard]] static JsonValue object(const std::vector<std::pair<std::string, JsonValue>>& members);
  /// A list on one line.
  [[nodiscard]] static JsonValue list(const std::vector<JsonValue>& values);

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  JsonValue() = default;
  std::string text_;
};

}  // namespace evert
