#include "yaml.hpp"

#include "evert/core/error.hpp"

#include <yaml-cpp/yaml.h>

#include <vector>

namespace evert {
namespace {

using schema::Value;

constexpr int deepest = 32;
constexpr int most_values = 200'000;

/// Copies a tree of yaml-cpp's into ours.
class Converter {
 public:
  Converter(std::string source, bool with_lines) : source_(std::move(source)), with_lines_(with_lines) {}

  Value convert(const YAML::Node& node, const YAML::Mark& parent, int depth) {
    // an alias that contains itself is never null, and yaml-cpp gives generated nodes the mark -1
    const auto mark = node.Mark().line >= 0 ? node.Mark() : parent;
    Value value{.where = where(mark)};
    if (depth > deepest)
      throw UserError(value.where + ": nested more than " + std::to_string(deepest) + " levels deep");
    if (++values_ > most_values)
      throw UserError(value.where + ": more than " + std::to_string(most_values) +
                      " values (aliases expanded)");
    if (node.IsScalar()) {
      value.kind = Value::Kind::scalar;
      value.text = node.Scalar();
      value.quoted = node.Tag() == "!";
    } else if (node.IsSequence()) {
      value.kind = Value::Kind::list;
      for (const auto& item : node) value.items.push_back(convert(item, mark, depth + 1));
    } else if (node.IsMap()) {
      convert_map(node, mark, depth, value);
    }
    if (!node.Tag().empty() && node.Tag() != "!" && node.Tag() != "?")
      throw UserError(value.where + ": the tag " + schema::shown(node.Tag()) +
                      " is not allowed: scenes have none");
    return value;
  }

 private:
  void convert_map(const YAML::Node& node, const YAML::Mark& mark, int depth, Value& value) {
    value.kind = Value::Kind::map;
    for (const auto& entry : node) {
      const auto& key = entry.first;
      const auto key_where = where(key.Mark().line >= 0 ? key.Mark() : mark);
      if (!key.IsScalar()) throw UserError(key_where + ": a key must be a word, not a list or a map");
      if (const auto* first = value.find(key.Scalar()))
        throw UserError(key_where + ": duplicate key " + schema::shown(key.Scalar()) + ", first given at " +
                        first->where);
      auto converted = convert(entry.second, key.Mark(), depth + 1);
      converted.where = key_where;  // the line of the key: what a reader looks for, and where a block begins
      value.entries.emplace_back(key.Scalar(), std::move(converted));
    }
  }

  [[nodiscard]] std::string where(const YAML::Mark& mark) const {
    return with_lines_ ? source_ + ":" + std::to_string(mark.line + 1) : source_;
  }

  std::string source_;
  bool with_lines_;
  int values_ = 0;
};

/// yaml-cpp's sentence about bad syntax, as the end of one of ours.
std::string not_yaml(const YAML::Exception& error) { return "not valid YAML: " + error.msg; }

}  // namespace

Value parse_yaml(std::string_view text, const std::string& source) {
  if (text.find('\0') != std::string_view::npos)
    throw UserError(source + ": holds zero bytes: a scene is YAML text");
  try {
    const auto documents = YAML::LoadAll(std::string(text));
    if (documents.empty() || documents.front().IsNull()) throw UserError(source + ": holds nothing");
    if (documents.size() > 1)
      throw UserError(source + ": holds " + std::to_string(documents.size()) +
                      " YAML documents, must be one");
    if (!documents.front().IsMap())
      throw UserError(
          source + ":1: must be a map of keys (name: ..., end_time: ...), not " +
          (documents.front().IsSequence() ? "a list" : schema::shown(documents.front().Scalar())));
    return Converter(source, true).convert(documents.front(), YAML::Mark(), 0);
  } catch (const YAML::Exception& error) {
    throw UserError(source + ":" + std::to_string(error.mark.line + 1) + ": " + not_yaml(error));
  }
}

Value parse_yaml_value(std::string_view text, const std::string& where) {
  try {
    return Converter(where, false).convert(YAML::Load(std::string(text)), YAML::Mark(), 0);
  } catch (const YAML::Exception& error) {
    throw UserError(where + ": " + not_yaml(error));
  }
}

}  // namespace evert
