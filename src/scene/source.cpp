#include "evert/scene/source.hpp"

#include "evert/scene/load.hpp"

#include "overrides.hpp"
#include "scene_file.hpp"
#include "tables.hpp"
#include "yaml.hpp"
#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

namespace evert {
namespace {

using schema::Value;
namespace fs = std::filesystem;

std::vector<std::string> joined(std::vector<std::string> first, std::span<const std::string> second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Null: there is nothing at the path.
const Value* find_at(const Value& root, const std::string& path) {
  const Value* value = &root;
  for (std::size_t begin = 0; begin <= path.size() && value != nullptr;) {
    const auto end = std::min(path.find('.', begin), path.size());
    value = value->find(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return value;
}

bool names_a_file(const std::string& key) {
  constexpr std::array<std::string_view, 3> keys{"file", "surface", "deformations"};
  return std::ranges::find(keys, key) != keys.end();
}

/// Paths in a scene are relative to its file, those of overrides to the working directory.
void move_paths(Value& value, const fs::path& from, const fs::path& to) {
  for (auto& item : value.items) move_paths(item, from, to);
  for (auto& [key, entry] : value.entries) {
    if (!names_a_file(key) || entry.kind != Value::Kind::scalar) {
      move_paths(entry, from, to);
      continue;
    }
    const fs::path base = entry.where.starts_with("-set ") ? fs::path() : from;
    const auto target = fs::absolute(base / entry.text);
    entry.text = fs::path(entry.text).is_absolute() ? entry.text : target.lexically_relative(to).string();
    entry.quoted = true;
  }
}

bool is_list_of_maps(const Value& value) {
  return !value.items.empty() && value.items.front().kind == Value::Kind::map;
}

/// Maps are written key by key down to the keys of a body, flow style below.
void write_block(const Value& value, int depth, std::string& out) {
  constexpr int deepest = 3;
  const std::string indent(2 * static_cast<std::size_t>(depth), ' ');
  for (const auto& [key, entry] : value.entries) {
    out += indent + key + ":";
    if (entry.kind == Value::Kind::map && depth + 1 < deepest && !entry.entries.empty()) {
      out += '\n';
      write_block(entry, depth + 1, out);
    } else if (is_list_of_maps(entry)) {
      for (const auto& item : entry.items) out += "\n" + indent + "  - " + canonical_text(item);
      out += '\n';
    } else {
      out += " " + canonical_text(entry) + '\n';
    }
  }
}

}  // namespace

SceneSource::SceneSource(MPI_Comm comm, const std::string& path, std::vector<std::string> overrides)
    : SceneSource(read_scene_file(comm, path), path, std::move(overrides)) {}

SceneSource::SceneSource(std::string text, std::string file, std::vector<std::string> overrides)
    : text_(std::move(text)), file_(std::move(file)), overrides_(std::move(overrides)) {
  static_cast<void>(variant());
}

SceneConfig SceneSource::variant(std::span<const std::string> overrides) const {
  return parse_scene(text_, file_, joined(overrides_, overrides));
}

std::optional<std::string> SceneSource::value_at(const std::string& path) const {
  auto root = parse_yaml(text_, file_);
  apply_overrides(root, scene_table().info(), overrides_);
  const auto* value = find_at(root, path);
  return value == nullptr ? std::nullopt : std::optional(canonical_text(*value));
}

std::vector<std::string> SceneSource::names_at(const std::string& path) const {
  auto root = parse_yaml(text_, file_);
  apply_overrides(root, scene_table().info(), overrides_);
  std::vector<std::string> names;
  if (const auto* value = find_at(root, path))
    for (const auto& entry : value->entries) names.push_back(entry.first);
  return names;
}

std::string SceneSource::yaml(std::span<const std::string> overrides, const std::string& folder) const {
  auto root = parse_yaml(text_, file_);
  apply_overrides(root, scene_table().info(), joined(overrides_, overrides));
  const auto from = fs::absolute(file_).parent_path();
  for (const auto* key : {"bodies", "obstacles"})
    if (auto* map = root.find(key)) move_paths(*map, from, fs::absolute(folder).lexically_normal());
  std::string out;
  write_block(root, 0, out);
  return out;
}

}  // namespace evert
