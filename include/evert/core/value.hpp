#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Configuration values before they have a meaning: what a YAML parser (or any other) delivers to a schema.
namespace evert::schema {

/// A scalar, a list or a map, with the place it was written at.
struct Value {
  enum class Kind { null, scalar, list, map };

  Kind kind = Kind::null;
  std::string where{};  ///< "scene.yaml:12", or the override it came from
  std::string text{};   ///< of a scalar
  bool quoted = false;  ///< a quoted scalar is text, never a number or a word of ours
  std::vector<Value> items{};
  std::vector<std::pair<std::string, Value>> entries{};  ///< of a map, in order; keys differ

  /// The value of `key`, or nullptr when there is none or this is no map.
  [[nodiscard]] const Value* find(std::string_view key) const;
  [[nodiscard]] Value* find(std::string_view key);
  /// Sets the value of `key`, adding it at the end when there is none. This must be a map or null.
  void set(const std::string& key, Value value);
  void erase(std::string_view key);
};

/// "torus" and "mesh" → "torus.mesh"; "" and "mesh" → "mesh".
[[nodiscard]] std::string join(std::string_view path, std::string_view key);

/// "'5 cm'", "a list", "a map" or "nothing", for messages: one short line whatever the text holds.
[[nodiscard]] std::string shown(const Value& value);
/// The text in quotes, shortened, control characters escaped.
[[nodiscard]] std::string shown(std::string_view text);

/// One line of flow-style text; equal values have equal texts wherever they stand.
[[nodiscard]] std::string canonical_text(const Value& value);

/// Throws UserError "<where>: <path>: <sentence>".
[[noreturn]] void fail(const Value& value, std::string_view path, const std::string& sentence);

}  // namespace evert::schema
