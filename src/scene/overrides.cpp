#include "overrides.hpp"

#include "evert/core/error.hpp"

#include "yaml.hpp"
#include <algorithm>
#include <charconv>
#include <optional>
#include <vector>

namespace evert {
namespace {

using schema::KeyInfo;
using schema::TableInfo;
using schema::TypeInfo;
using schema::Value;

std::vector<std::string> names_in(const Value& map) {
  std::vector<std::string> names;
  for (const auto& entry : map.entries) names.push_back(entry.first);
  return names;
}

/// Walks down one path and sets the value at its end.
class Override {
 public:
  explicit Override(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UserError("-set " + text + ": must be path=value, e.g. -set integrator.time_step=1e-4");
    path_ = text.substr(0, equals);
    where_ = "-set " + path_;
    value_ = parse_yaml_value(std::string_view(text).substr(equals + 1), where_);
    for (std::size_t begin = 0; begin <= path_.size();) {
      const auto end = std::min(path_.find('.', begin), path_.size());
      parts_.push_back(path_.substr(begin, end - begin));
      begin = end + 1;
    }
  }

  void apply(Value& scene, const TableInfo& table) { in_table(scene, table, 0); }

 private:
  [[noreturn]] void wrong(std::size_t part, const std::string& sentence) const {
    throw UserError(where_ + ": " + schema::shown(parts_[part]) + " " + sentence);
  }

  [[nodiscard]] bool last(std::size_t part) const { return part + 1 == parts_.size(); }

  /// parts_[part] is a key of the table that `map` is read by.
  void in_table(Value& map, const TableInfo& table, std::size_t part) {
    const auto& key = parts_[part];
    const auto known = table.key_names();
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      const auto suggestion = did_you_mean(key, known);
      wrong(part,
            "is an unknown key" + (suggestion.empty() ? "; known there are " + list_of(known) : suggestion));
    }
    if (last(part)) {
      if (map.kind != Value::Kind::map && map.kind != Value::Kind::null)
        wrong(part, "is not in a map of keys");
      set_key(map, table, key);
      return;
    }
    const auto* info = table.find(key);
    if (info == nullptr) wrong(part + 1, "is one too many: the path ends before it");
    inside(map, *info, part);
  }

  /// The path goes on below the key `info` of `map`.
  void inside(Value& map, const KeyInfo& info, std::size_t part) {
    const bool absent = map.find(info.name) == nullptr;
    if (absent) map.set(info.name, Value{.kind = Value::Kind::null, .where = where_});
    below(*map.find(info.name), info, part);
    // taking a key away from a block that is not there must not leave an empty one
    if (absent && map.find(info.name)->kind == Value::Kind::null) map.erase(info.name);
  }

  void below(Value& value, const KeyInfo& info, std::size_t part) {
    switch (info.type.shape) {
      case TypeInfo::Shape::table:
        return in_table(value, *info.type.table, part + 1);
      case TypeInfo::Shape::named_tables:
        return in_named(value, *info.type.table, part + 1);
      case TypeInfo::Shape::list_of_tables:
        return in_list(value, info.type.table, part + 1);
      case TypeInfo::Shape::named_scalars:
        if (!last(part + 1)) wrong(part + 2, "is one too many: the path ends before it");
        return assign(value, parts_[part + 1]);
      case TypeInfo::Shape::simple:
        return in_list(value, nullptr, part + 1);
    }
  }

  /// parts_[part] is the name of a body or obstacle; it must be there, or a misspelt name would make a new
  /// one.
  void in_named(Value& map, const TableInfo& table, std::size_t part) {
    auto* entry = map.find(parts_[part]);
    if (entry == nullptr) {
      const auto names = names_in(map);
      const auto suggestion = did_you_mean(parts_[part], names);
      if (names.empty()) wrong(part, "is not in the scene, which has none there");
      wrong(part,
            "is not in the scene" + (suggestion.empty() ? ", which has " + list_of(names) : suggestion));
    }
    if (last(part))
      assign(map, parts_[part]);
    else
      in_table(*entry, table, part + 1);
  }

  /// parts_[part] is an index into a list; `table` is null when its items are single values.
  void in_list(Value& list, const TableInfo* table, std::size_t part) {
    const auto& text = parts_[part];
    std::size_t index = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), index);
    if (list.kind != Value::Kind::list) wrong(part, "is no index: the scene has no list there");
    if (result.ec != std::errc() || result.ptr != text.data() + text.size() || index >= list.items.size())
      wrong(part, "is no index of the list, which has " + std::to_string(list.items.size()) + " items");
    if (last(part))
      list.items[index] = value_;
    else if (table != nullptr)
      in_table(list.items[index], *table, part + 1);
    else
      wrong(part + 1, "is one too many: the path ends before it");
  }

  /// Sets a key of a table, after taking away what goes with another alternative.
  void set_key(Value& map, const TableInfo& table, const std::string& key) {
    const bool is_tag = key == table.tag;
    for (const auto& alternative : table.alternatives) {
      const bool chosen =
          alternative.by_tag ? is_tag && value_.text == alternative.name : key == alternative.name;
      if (!chosen) continue;
      const auto stay = table.key_names(&alternative);
      std::erase_if(map.entries, [&](const auto& entry) {
        return table.find(entry.first) != nullptr &&
               std::find(stay.begin(), stay.end(), entry.first) == stay.end();
      });
      if (!alternative.by_tag && !table.tag.empty()) map.erase(table.tag);
    }
    assign(map, key);
  }

  void assign(Value& map, const std::string& key) {
    if (value_.kind == Value::Kind::null)
      map.erase(key);
    else
      map.set(key, value_);
  }

  std::string where_;
  std::string path_;
  std::vector<std::string> parts_;
  Value value_;
};

}  // namespace

void apply_overrides(Value& scene, const TableInfo& table, std::span<const std::string> overrides) {
  for (const auto& text : overrides) Override(text).apply(scene, table);
}

}  // namespace evert
