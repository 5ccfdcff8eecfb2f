#include "evert/scene/reference.hpp"

#include "evert/core/error.hpp"

#include "tables.hpp"
#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

namespace evert {
namespace {

using schema::AlternativeInfo;
using schema::KeyInfo;
using schema::TableInfo;
using schema::TypeInfo;

using Path = std::vector<std::string>;

/// What stands for the default of a key that chooses between alternatives.
constexpr std::string_view one_of_several = "one of several";

/// A key and where it stands.
struct Entry {
  Path path;
  KeyInfo key;
  std::string alternative;  ///< "generate: torus" when the key goes with that only
};

std::string text_of(const Path& path) {
  std::string text;
  for (const auto& part : path) text = schema::join(text, part);
  return text;
}

Path with(Path path, const std::string& part) {
  path.push_back(part);
  return path;
}

/// What stands for the name or the number of an item.
std::string placeholder(const TypeInfo& type) {
  return type.shape == TypeInfo::Shape::named_tables ? "<name>" : "<index>";
}

Path below(const Entry& entry) {
  const bool one = entry.key.type.shape == TypeInfo::Shape::table;
  return one ? entry.path : with(entry.path, placeholder(entry.key.type));
}

std::string label(const TableInfo& table, const AlternativeInfo& alternative) {
  return alternative.by_tag ? table.tag + ": " + alternative.name : alternative.name;
}

/// The tag as a key like the others.
KeyInfo tag_key(const TableInfo& table) {
  KeyInfo key{table.tag, {.name = "word"}, true, "", "", table.tag_help};
  for (const auto& alternative : table.alternatives) {
    if (alternative.by_tag)
      key.type.choices.push_back({alternative.name, alternative.table->help});
    else
      key.required = false;
  }
  key.example = key.type.choices.front().word;
  return key;
}

/// The keys of an alternative; the one that chooses it is one of several.
std::vector<KeyInfo> keys_of(const AlternativeInfo& alternative) {
  auto keys = alternative.table->keys;
  for (auto& key : keys) {
    if (alternative.by_tag || key.name != alternative.name) continue;
    key.required = false;
    key.default_text = one_of_several;
  }
  return keys;
}

/// The keys of a table itself: tag, own keys, keys of the alternatives.
std::vector<Entry> entries_of(const TableInfo& table, const Path& path) {
  std::vector<Entry> out;
  if (!table.tag.empty()) {
    const auto key = tag_key(table);
    out.push_back({with(path, key.name), key, ""});
  }
  for (const auto& alternative : table.alternatives)
    for (const auto& key : keys_of(alternative))
      out.push_back({with(path, key.name), key, label(table, alternative)});
  for (const auto& key : table.keys) out.push_back({with(path, key.name), key, ""});
  return out;
}

/// A table that occurs within itself is not visited there again: `within` are those that the path goes
/// through.
void visit_all(const TableInfo& table, const Path& path, const auto& visit,
               std::vector<const TableInfo*> within = {}) {
  within.push_back(&table);
  for (const auto& entry : entries_of(table, path)) {
    visit(entry);
    const auto* next = entry.key.type.table;
    if (next != nullptr && std::ranges::find(within, next) == within.end())
      visit_all(*next, below(entry), visit, within);
  }
}

std::string type_text(const TypeInfo& type) {
  return type.name + (type.unit.empty() ? "" : " [" + type.unit + "]");
}

std::string allowed_text(const TypeInfo& type) {
  std::vector<std::string> words;
  for (const auto& choice : type.choices) words.push_back(choice.word);
  return words.empty() ? type.range : list_of(words);
}

std::string default_text(const KeyInfo& key) {
  if (key.required) return "required";
  return key.default_text.empty() ? "-" : key.default_text;
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(text.size() + 1, width), ' ');
  return text;
}

// --- one key

/// Whether the query is the end of the path; names and indices may be left out of it, but it does not begin
/// with one.
bool names_end_of(const Path& path, std::size_t path_size, const Path& query, std::size_t query_size) {
  if (query_size == 0) return true;
  if (path_size == 0) return false;
  const auto& part = path[path_size - 1];
  if (part.starts_with('<'))
    return names_end_of(path, path_size - 1, query, query_size) ||
           (query_size > 1 && names_end_of(path, path_size - 1, query, query_size - 1));
  return part == query[query_size - 1] && names_end_of(path, path_size - 1, query, query_size - 1);
}

void append_line(std::string& out, const std::string& what, const std::string& text) {
  if (!text.empty()) out += "  " + padded(what, 10) + text + "\n";
}

void append_details(std::string& out, const Entry& entry) {
  const auto& key = entry.key;
  out +=
      text_of(entry.path) + (entry.alternative.empty() ? "" : "    (with " + entry.alternative + ")") + "\n";
  out += "  " + key.help + "\n";
  append_line(out, "type", type_text(key.type));
  append_line(out, "allowed", allowed_text(key.type));
  append_line(out, "default", default_text(key));
  append_line(out, "example", key.name + ": " + key.example);
  for (const auto& choice : key.type.choices) append_line(out, "", padded(choice.word, 22) + choice.help);
  if (key.type.table == nullptr) return;
  std::string keys;
  for (const auto& name : key.type.table->key_names()) keys += (keys.empty() ? "" : ", ") + name;
  append_line(out, "keys", keys);
}

// --- all keys

/// Adds the words of `text` to a line that has `column` characters; the lines that follow begin there too.
void append_wrapped(std::string& out, const std::string& text, std::size_t column) {
  constexpr std::size_t width = 100;
  std::istringstream words(text);
  std::size_t at = column;
  for (std::string word; words >> word;) {
    if (at > column && at + 1 + word.size() > width) {
      out += "\n" + std::string(column, ' ');
      at = column;
    } else if (at > column) {
      out += ' ';
      ++at;
    }
    out += word;
    at += word.size();
  }
  out += '\n';
}

void append_tree_line(std::string& out, const std::string& indent, const KeyInfo& key) {
  constexpr std::size_t column = 38;
  const auto unit = key.type.unit.empty() ? "" : " [" + key.type.unit + "]";
  out += padded(indent + key.name + (key.required ? "*" : "") + unit, column);
  std::string text = key.help;
  if (!key.type.choices.empty()) text += " One of " + allowed_text(key.type) + ".";
  const bool has_default = !key.required && !key.default_text.empty() && key.default_text != "[]" &&
                           key.default_text != one_of_several;
  if (has_default) text += " Default: " + key.default_text + ".";
  append_wrapped(out, text, column);
}

// --- the page

constexpr std::string_view page_head = R"(# The scene file

*Generated by `evert explain -markdown` from the tables that read scenes; `scripts/make-reference` renews it.*

A scene is one YAML file. Numbers are in SI units and written without them. An unknown key is an error; a feature
that is not named is not there and costs nothing. Every key can be set from the command line with
`-set path=value`, the path as below with the names of the scene, e.g.
`-set bodies.torus.mesh.edge_length=0.02` or `-set constraints.0.until=1`; `null` takes a key away, and a new
`mesh.file`, `mesh.generate` or `shape` takes the keys away that go with another one. `-` as a default says that the
key has none: what is not given is not there.
)";

void append_rows(std::string& out, const std::vector<KeyInfo>& keys) {
  out += "\n| key | type | allowed | default | meaning |\n|---|---|---|---|---|\n";
  for (const auto& key : keys)
    out += "| `" + key.name + "` | " + type_text(key.type) + " | " + allowed_text(key.type) + " | " +
           default_text(key) + " | " + key.help + " E.g. `" + key.name + ": " + key.example + "` |\n";
}

void append_choices(std::string& out, const std::vector<KeyInfo>& keys) {
  for (const auto& key : keys) {
    if (key.type.choices.empty()) continue;
    out += "\n`" + key.name + "`:\n\n";
    for (const auto& choice : key.type.choices)
      out += "- `" + choice.word + "`" + (choice.help.empty() ? "" : ": " + choice.help) + "\n";
  }
}

/// One section for every table; a table that occurs again is referred to.
class Page {
 public:
  void append_section(const TableInfo& table, const Path& path, const std::string& title) {
    sections_[&table] = title;
    text_ += "\n## " + title + "\n\n" + table.help + "\n";
    auto keys = table.keys;
    if (!table.tag.empty()) keys.insert(keys.begin(), tag_key(table));
    if (!keys.empty()) append_rows(text_, keys);
    append_choices(text_, keys);
    for (const auto& alternative : table.alternatives) {
      text_ += "\n### With `" + label(table, alternative) + "`\n\n" + alternative.table->help + "\n";
      const auto own = keys_of(alternative);
      if (!own.empty()) append_rows(text_, own);
      append_choices(text_, own);
    }
    for (const auto& entry : entries_of(table, path)) append_below(entry);
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void append_below(const Entry& entry) {
    const auto* table = entry.key.type.table;
    if (table == nullptr) return;
    const auto title = "`" + text_of(below(entry)) + "`";
    if (const auto first = sections_.find(table); first != sections_.end())
      text_ += "\n## " + title + "\n\nThe keys of " + first->second + ".\n";
    else
      append_section(*table, below(entry), title);
  }

  std::string text_{page_head};
  std::map<const TableInfo*, std::string> sections_;
};

}  // namespace

std::string reference_tree() {
  std::string out =
      "Every key of a scene; * marks those that must be given. 'evert explain KEY' says more.\n\n";
  std::string alternative;
  visit_all(scene_table().info(), {}, [&](const Entry& entry) {
    const auto indent = std::string(2 * (entry.path.size() - 1), ' ');
    if (entry.alternative != alternative && !entry.alternative.empty())
      out += indent + "with " + entry.alternative + "\n";
    alternative = entry.alternative;
    append_tree_line(out, indent + (alternative.empty() ? "" : "  "), entry.key);
    if (below(entry) != entry.path && entry.key.type.table != nullptr)
      out += indent + "  " + placeholder(entry.key.type) + "\n";
  });
  return out;
}

std::string reference_of(std::string_view query) {
  Path parts;
  for (std::size_t begin = 0; begin <= query.size();) {
    const auto end = std::min(query.find('.', begin), query.size());
    parts.emplace_back(query.substr(begin, end - begin));
    begin = end + 1;
  }
  std::string out;
  std::vector<std::string> known;
  visit_all(scene_table().info(), {}, [&](const Entry& entry) {
    known.push_back(entry.key.name);
    known.push_back(text_of(entry.path));
    if (!names_end_of(entry.path, entry.path.size(), parts, parts.size())) return;
    if (!out.empty()) out += "\n";
    append_details(out, entry);
  });
  if (out.empty())
    throw UserError(schema::shown(query) + " is no key of a scene" + did_you_mean(query, known) +
                    "; 'evert explain' lists all");
  return out;
}

std::string reference_markdown() {
  Page page;
  page.append_section(scene_table().info(), {}, "At the top");
  return page.text();
}

}  // namespace evert
