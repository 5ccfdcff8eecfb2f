#include "evert/core/schema.hpp"

#include "evert/core/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace evert::schema {
namespace {

std::string written(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

/// A scalar's text, or an error that says what was expected.
const std::string& scalar(const Value& value, const std::string& path, const std::string& expected) {
  if (value.kind != Value::Kind::scalar) fail(value, path, "must be " + expected + ", not " + shown(value));
  return value.text;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// "5 cm", "30deg", "1e5 Pa": a number, then a word.
bool has_unit(std::string_view rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  return !rest.empty() &&
         (is_letter(rest.front()) || rest.front() == '%' || static_cast<unsigned char>(rest.front()) >= 0x80);
}

double read_number(const Value& value, const std::string& path, const std::string& unit, const Range& range,
                   const std::string& expected) {
  const auto& text = scalar(value, path, expected);
  const auto wrong = [&](const std::string& why) { fail(value, path, shown(value) + why); };
  if (value.quoted) wrong(" is text in quotes: must be " + expected);
  const bool plus = text.starts_with('+') && !text.starts_with("+-");  // from_chars knows no plus
  const char* begin = text.data() + (plus ? 1 : 0);
  const char* end = text.data() + text.size();
  double number = 0;
  const auto result = std::from_chars(begin, end, number);
  if (text == ".nan" || text == ".NaN" || text == ".NAN" || text.ends_with(".inf") || text.ends_with(".Inf"))
    wrong(" is not allowed: must be finite");
  if (result.ec == std::errc::result_out_of_range) wrong(" does not fit into a double-precision number");
  if (result.ec != std::errc() || begin == end) wrong(" is not allowed: must be " + expected);
  if (!std::isfinite(number)) wrong(" is not allowed: must be finite");
  if (result.ptr != end) {
    if (has_unit({result.ptr, static_cast<std::size_t>(end - result.ptr)}))
      wrong(" has a unit: write the SI number alone" +
            (unit.empty() || unit == "-" ? "" : " [" + unit + "]"));
    wrong(" is not allowed: must be " + expected);
  }
  if (!range.contains(number)) wrong(" is not allowed: must be " + range.text());
  return number;
}

/// The words after a ": " of alternatives: "'file' or 'generate: box'".
std::vector<std::string> alternative_names(const TableInfo& table) {
  std::vector<std::string> names;
  for (const auto& alternative : table.alternatives)
    names.push_back(alternative.by_tag ? table.tag + ": " + alternative.name : alternative.name);
  return names;
}

void append_key_names(const TableInfo& table, std::vector<std::string>& names) {
  for (const auto& key : table.keys)
    if (std::find(names.begin(), names.end(), key.name) == names.end()) names.push_back(key.name);
}

[[noreturn]] void fail_unknown_key(const TableInfo& table, const AlternativeInfo* chosen, const Value& map,
                                   const std::string& key, const Value& value, const std::string& path) {
  const auto known = table.key_names(chosen);
  if (table.find(key) != nullptr && chosen != nullptr) {
    const std::string which = chosen->by_tag ? table.tag + ": " + map.find(table.tag)->text : chosen->name;
    fail(value, join(path, key), "does not go with '" + which + "'; known there are " + list_of(known));
  }
  const auto suggestion = did_you_mean(key, known);
  fail(value, join(path, key),
       "unknown key" + (suggestion.empty() ? "; known here are " + list_of(known) : suggestion));
}

void check_required(const TableInfo& table, const Value& map, const std::string& path) {
  for (const auto& key : table.keys) {
    if (!key.required || map.find(key.name) != nullptr) continue;
    const auto& unit = key.type.unit;
    fail(map, path,
         "'" + key.name + "' is missing" + (unit.empty() ? "" : " [" + unit + "]") + ", e.g. " + key.name +
             ": " + key.example);
  }
}

/// Throws when the alternative is not clear. Returns its index, npos when the table has none.
std::size_t choose(const TableInfo& table, const Value& map, const std::string& path) {
  if (table.alternatives.empty()) return std::string::npos;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < table.alternatives.size(); ++i)
    if (!table.alternatives[i].by_tag && map.find(table.alternatives[i].name) != nullptr) found.push_back(i);
  if (const auto* tag = table.tag.empty() ? nullptr : map.find(table.tag)) {
    std::vector<ChoiceInfo> words;
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < table.alternatives.size(); ++i)
      if (table.alternatives[i].by_tag) {
        words.push_back({table.alternatives[i].name, ""});
        indices.push_back(i);
      }
    found.push_back(indices[read_choice(*tag, join(path, table.tag), words)]);
  }
  if (found.size() == 1) return found.front();
  const auto names = alternative_names(table);
  if (!found.empty())
    fail(map, path, "'" + names[found[0]] + "' and '" + names[found[1]] + "' exclude each other");
  if (std::all_of(table.alternatives.begin(), table.alternatives.end(),
                  [](const auto& a) { return a.by_tag; }))
    for (const auto& [key, value] : map.entries)  // a misspelt tag is more likely than a missing one
      if (table.find(key) == nullptr && nearest_match(key, std::vector{table.tag}) == table.tag)
        fail_unknown_key(table, nullptr, map, key, value, path);
  fail(map, path, "needs one of '" + list_of(names) + "'");
}

}  // namespace

bool Range::contains(double value) const {
  if (low && (low_open ? value <= *low : value < *low)) return false;
  return !(high && (high_open ? value >= *high : value > *high));
}

std::string Range::text() const {
  if (low && high)
    return std::string("in ") + (low_open ? "(" : "[") + written(*low) + ", " + written(*high) +
           (high_open ? ")" : "]");
  if (low) return (low_open ? "> " : ">= ") + written(*low);
  if (high) return (high_open ? "< " : "<= ") + written(*high);
  return "";
}

const AlternativeInfo* TableInfo::chosen(const Value& map) const {
  const AlternativeInfo* found = nullptr;
  for (const auto& alternative : alternatives) {
    const auto* value = map.find(alternative.by_tag ? tag : alternative.name);
    if (value == nullptr || (alternative.by_tag && value->text != alternative.name)) continue;
    if (found != nullptr) return nullptr;
    found = &alternative;
  }
  return found;
}

std::vector<std::string> TableInfo::key_names(const AlternativeInfo* alternative) const {
  std::vector<std::string> names;
  if (!tag.empty() && (alternative == nullptr || alternative->by_tag)) names.push_back(tag);
  if (alternative != nullptr)
    append_key_names(*alternative->table, names);
  else
    for (const auto& each : alternatives) append_key_names(*each.table, names);
  append_key_names(*this, names);
  return names;
}

const KeyInfo* TableInfo::find(std::string_view key) const {
  for (const auto& own : keys)
    if (own.name == key) return &own;
  for (const auto& alternative : alternatives)
    if (const auto* found = alternative.table->find(key)) return found;
  return nullptr;
}

Type<double> number(const std::string& unit, const Range& range) {
  return {.info = {.name = "number", .unit = unit, .range = range.text()},
          .read = [unit, range](
                      const Value& value,
                      const std::string& path) { return read_number(value, path, unit, range, "a number"); },
          .write = written};
}

Type<std::optional<double>> word_or_number(const std::string& word, const std::string& unit,
                                           const Range& range) {
  return {.info = {.name = "'" + word + "' or number", .unit = unit, .range = range.text()},
          .read = [=](const Value& value, const std::string& path) -> std::optional<double> {
            if (value.kind == Value::Kind::scalar && value.text == word) return std::nullopt;
            return read_number(value, path, unit, range, "'" + word + "' or a number");
          },
          .write = [word](const std::optional<double>& value) { return value ? written(*value) : word; }};
}

namespace {

template <class Integer>
Type<Integer> integer_type(Integer low, Integer high) {
  const std::string allowed = "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
  return {.info = {.name = "whole number",
                   .range = "in [" + std::to_string(low) + ", " + std::to_string(high) + "]"},
          .read =
              [=](const Value& value, const std::string& path) {
                const auto& text = scalar(value, path, allowed);
                Integer number = 0;
                const auto* end = text.data() + text.size();
                const auto result = std::from_chars(text.data(), end, number);
                if (value.quoted || result.ec != std::errc() || result.ptr != end || number < low ||
                    number > high)
                  fail(value, path, shown(value) + " is not allowed: must be " + allowed);
                return number;
              },
          .write = [](const Integer& value) { return std::to_string(value); }};
}

}  // namespace

Type<int> integer(int low, int high) { return integer_type<int>(low, high); }

Type<std::uint64_t> seed_number() { return integer_type<std::uint64_t>(0, 1'000'000'000'000'000'000); }

Type<bool> yes_or_no() {
  return {.info = {.name = "true or false"},
          .read =
              [](const Value& value, const std::string& path) {
                const auto& text = scalar(value, path, "true or false");
                if (value.quoted || (text != "true" && text != "false"))
                  fail(value, path, shown(value) + " is not allowed: must be true or false");
                return text == "true";
              },
          .write = [](const bool& value) { return std::string(value ? "true" : "false"); }};
}

Type<std::string> text(const std::string& what) {
  return {.info = {.name = what},
          .read =
              [what](const Value& value, const std::string& path) {
                const auto& written_text = scalar(value, path, "a " + what);
                if (written_text.empty()) fail(value, path, "must not be empty");
                if (std::any_of(written_text.begin(), written_text.end(),
                                [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
                  fail(value, path,
                       shown(value) + " is not allowed: must be one line without control characters");
                return written_text;
              },
          .write = [](const std::string& value) { return value; }};
}

Type<std::vector<std::pair<std::string, std::string>>> scalars_by_name(const std::string& what) {
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  return {.info = {.name = what, .shape = TypeInfo::Shape::named_scalars},
          .read =
              [](const Value& value, const std::string& path) {
                expect_map(value, path);
                Pairs out;
                for (const auto& [name, entry] : value.entries) {
                  expect_name(entry, path, name);
                  out.emplace_back(name, entry.kind == Value::Kind::null
                                             ? std::string()
                                             : scalar(entry, join(path, name), "a number or a word"));
                }
                return out;
              },
          .write = [](const Pairs&) { return std::string(); }};
}

void expect_list(const Value& value, const std::string& path, std::size_t length, const std::string& what) {
  if (value.kind != Value::Kind::list)
    fail(value, path, "must be a list" + (length > 0 ? " of " + what : "") + ", not " + shown(value));
  if (length > 0 && value.items.size() != length)
    fail(value, path, "must be a list of " + what + ", not of " + std::to_string(value.items.size()));
}

void expect_map(const Value& value, const std::string& path) {
  if (value.kind != Value::Kind::map) fail(value, path, "must be a map of keys, not " + shown(value));
}

std::size_t read_choice(const Value& value, const std::string& path, std::span<const ChoiceInfo> choices) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.word);
  const auto& word = scalar(value, path, list_of(words));
  const auto it = std::find(words.begin(), words.end(), word);
  if (it == words.end())
    fail(value, path,
         shown(value) + " is not allowed: must be " + list_of(words) + did_you_mean(word, words));
  return static_cast<std::size_t>(it - words.begin());
}

void expect_name(const Value& value, const std::string& path, const std::string& name) {
  const bool good = !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](char c) {
    return is_letter(c) || is_digit(c) || c == '_' || c == '-';
  });
  if (!good)
    fail(value, path, "the name " + shown(name) + " is not allowed: must be 1 to 64 letters, digits, _ or -");
}

std::size_t check_keys(const TableInfo& table, const Value& map, const std::string& path) {
  expect_map(map, path);
  const auto index = choose(table, map, path);
  const auto* chosen = index < table.alternatives.size() ? &table.alternatives[index] : nullptr;
  const auto known = table.key_names(chosen);
  for (const auto& [key, value] : map.entries) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      fail_unknown_key(table, chosen, map, key, value, path);
    if (value.kind == Value::Kind::null) fail(value, join(path, key), "has no value");
  }
  if (chosen != nullptr) check_required(*chosen->table, map, path);
  check_required(table, map, path);
  return index;
}

}  // namespace evert::schema
