#pragma once
#include "evert/core/value.hpp"

#include <string>
#include <string_view>

/// YAML text to configuration values: the only place that knows yaml-cpp.
namespace evert {

/// The one document in `text`. `source` names it in messages ("scene.yaml"). Throws UserError with file and
/// line for what is no YAML, for several documents, duplicate keys (yaml-cpp keeps both in silence), keys
/// that are not plain words, and for documents whose depth or size (aliases expanded) no scene has.
[[nodiscard]] schema::Value parse_yaml(std::string_view text, const std::string& source);

/// A single value as after a key, for overrides; `where` is its place in messages.
[[nodiscard]] schema::Value parse_yaml_value(std::string_view text, const std::string& where);

}  // namespace evert
