#pragma once
#include "evert/core/value.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

/// Typed option tables: one table a struct says which key fills which member, with its type, unit, range,
/// example and help. Reading a scene, its error messages, its reference and the checks of overrides all come
/// from the tables.
///
///     const auto table = Table<Material>("An elastic material.")
///         .required("youngs_modulus", &Material::youngs_modulus, number("Pa", at_least(0)), "1e5",
///         "Stiffness.") .optional("limit", &Material::limit, number("-", between(0, 1)), "0.3", "Where the
///         extension begins.");
///     Material material = table.read(value, "bodies.torus.material");
namespace evert::schema {

// --- what the tables say, without types

/// Which numbers are allowed.
struct Range {
  std::optional<double> low{}, high{};
  bool low_open = false, high_open = false;

  [[nodiscard]] bool contains(double value) const;
  /// ">= 0", "in (-1, 0.5)", or "" when every number is.
  [[nodiscard]] std::string text() const;
};

[[nodiscard]] inline Range any_number() { return {}; }
[[nodiscard]] inline Range at_least(double low) { return {.low = low}; }
[[nodiscard]] inline Range above(double low) { return {.low = low, .low_open = true}; }
/// The open interval.
[[nodiscard]] inline Range between(double low, double high) {
  return {.low = low, .high = high, .low_open = true, .high_open = true};
}
/// The closed interval.
[[nodiscard]] inline Range from_to(double low, double high) { return {.low = low, .high = high}; }
/// low < value <= high.
[[nodiscard]] inline Range above_up_to(double low, double high) {
  return {.low = low, .high = high, .low_open = true};
}

struct TableInfo;

/// A word that a key may have as its value.
struct ChoiceInfo {
  std::string word;
  std::string help;
};

/// How a value is written.
struct TypeInfo {
  enum class Shape { simple, table, list_of_tables, named_tables, named_scalars };

  std::string name;    ///< "number", "3 numbers", "word", "map of name: table"
  std::string unit{};  ///< "Pa"; "" when it has none, "-" for a pure number
  std::string range{};
  std::vector<ChoiceInfo> choices{};
  Shape shape = Shape::simple;
  const TableInfo* table = nullptr;  ///< of the tables
};

struct KeyInfo {
  std::string name;
  TypeInfo type;
  bool required = false;
  std::string default_text;  ///< "" when absent means absent
  std::string example;       ///< the value, as in a scene
  std::string help;
};

/// One of several sets of keys: the one whose name is the value of the tag, or whose name is a key that is
/// present.
struct AlternativeInfo {
  std::string name;
  bool by_tag = true;
  const TableInfo* table = nullptr;
};

struct TableInfo {
  std::string help;
  std::string tag;  ///< the key that names the alternative; "" when all are known by presence
  std::string tag_help;
  std::vector<KeyInfo> keys;
  std::vector<AlternativeInfo> alternatives;  ///< none, or one of them must be chosen

  /// The alternative that `map` chooses; nullptr when none or several are.
  [[nodiscard]] const AlternativeInfo* chosen(const Value& map) const;
  /// All keys there are: own, tag, and those of `alternative` (of every alternative when it is nullptr).
  [[nodiscard]] std::vector<std::string> key_names(const AlternativeInfo* alternative = nullptr) const;
  /// The key, own or of an alternative; nullptr when there is none.
  [[nodiscard]] const KeyInfo* find(std::string_view key) const;
};

// --- types: how one value is read

template <class T>
struct Type {
  TypeInfo info;
  std::function<T(const Value&, const std::string& path)> read;  ///< throws UserError
  std::function<std::string(const T&)> write;                    ///< for defaults
};

/// A finite number in `range`. Units are never written in a scene: SI everywhere.
[[nodiscard]] Type<double> number(const std::string& unit, const Range& range = any_number());
/// The word (e.g. "auto"), read as an empty optional, or a number.
[[nodiscard]] Type<std::optional<double>> word_or_number(const std::string& word, const std::string& unit,
                                                         const Range& range);
[[nodiscard]] Type<int> integer(int low, int high);
[[nodiscard]] Type<std::uint64_t> seed_number();
[[nodiscard]] Type<bool> yes_or_no();
/// Any non-empty scalar; `what` is e.g. "path".
[[nodiscard]] Type<std::string> text(const std::string& what);
/// Any scalars by name, kept as text: options of another program.
[[nodiscard]] Type<std::vector<std::pair<std::string, std::string>>> scalars_by_name(const std::string& what);

/// Throws unless `value` is a list, of `length` items when that is not 0. `what` is e.g. "3 numbers".
void expect_list(const Value& value, const std::string& path, std::size_t length, const std::string& what);
void expect_map(const Value& value, const std::string& path);
/// Throws unless `word` is an unquoted or quoted scalar among the choices; returns its index.
[[nodiscard]] std::size_t read_choice(const Value& value, const std::string& path,
                                      std::span<const ChoiceInfo> choices);
/// Throws unless the key can be part of a path: letters, digits, _ and -.
void expect_name(const Value& value, const std::string& path, const std::string& name);

/// N values of one type; `plural` is e.g. "numbers".
template <std::size_t N, class T>
[[nodiscard]] Type<std::array<T, N>> array_of(const Type<T>& item, const std::string& plural) {
  const std::string what = std::to_string(N) + " " + plural;
  return {.info = {.name = what, .unit = item.info.unit, .range = item.info.range},
          .read =
              [item, what](const Value& value, const std::string& path) {
                expect_list(value, path, N, what);
                std::array<T, N> out{};
                for (std::size_t i = 0; i < N; ++i)
                  out[i] = item.read(value.items[i], path + "[" + std::to_string(i) + "]");
                return out;
              },
          .write =
              [item](const std::array<T, N>& values) {
                std::string out = "[";
                for (std::size_t i = 0; i < N; ++i) out += (i > 0 ? ", " : "") + item.write(values[i]);
                return out + "]";
              }};
}

/// A list of any length.
template <class T>
[[nodiscard]] Type<std::vector<T>> sequence_of(const Type<T>& item) {
  TypeInfo info = item.info;
  info.name = "list of: " + item.info.name;
  if (info.shape == TypeInfo::Shape::table) info.shape = TypeInfo::Shape::list_of_tables;
  return {.info = info,
          .read =
              [item](const Value& value, const std::string& path) {
                expect_list(value, path, 0, "");
                std::vector<T> out;
                for (std::size_t i = 0; i < value.items.size(); ++i)
                  out.push_back(item.read(value.items[i], path + "[" + std::to_string(i) + "]"));
                return out;
              },
          .write = [](const std::vector<T>& values) { return std::string(values.empty() ? "[]" : ""); }};
}

/// A word of ours and what it means.
template <class Enum>
struct Choice {
  std::string word;
  Enum value;
  std::string help;
};

template <class Enum>
[[nodiscard]] Type<Enum> one_of(const std::vector<Choice<Enum>>& choices) {
  TypeInfo info{.name = "word"};
  for (const auto& choice : choices) info.choices.push_back({choice.word, choice.help});
  return {.info = info,
          .read = [choices, words = info.choices](
                      const Value& value,
                      const std::string& path) { return choices[read_choice(value, path, words)].value; },
          .write =
              [choices](const Enum& value) {
                for (const auto& choice : choices)
                  if (choice.value == value) return choice.word;
                return std::string();
              }};
}

/// `type` whose value is converted by `convert(value, written value, path)`, which may throw through fail().
template <class To, class From, class Convert>
[[nodiscard]] Type<To> converted(const Type<From>& type, const std::string& name, Convert convert) {
  TypeInfo info = type.info;
  info.name = name;
  return {.info = info,
          .read = [type, convert](const Value& value, const std::string& path) -> To {
            return convert(type.read(value, path), value, path);
          },
          .write = [](const To&) { return std::string(); }};
}

// --- tables: how a struct is read

/// Throws when a key of `map` is unknown to the table, when the alternative is missing or doubtful, or when a
/// required key is missing. Returns the index of the chosen alternative, or npos when the table has none.
std::size_t check_keys(const TableInfo& table, const Value& map, const std::string& path);

template <class S>
class Table {
 public:
  using Reader = std::function<void(S&, const Value& map, const std::string& path)>;

  explicit Table(std::string help) { info_.help = std::move(help); }

  /// `member` is a pointer to a T, or to an optional T; or anything std::invoke makes a reference of.
  template <class Member, class T>
  Table& required(const std::string& name, Member member, const Type<T>& type, const std::string& example,
                  const std::string& help) {
    return add({name, type.info, true, "", example, help}, member, type);
  }

  /// Absent: the member keeps the value that S gives it.
  template <class Member, class T>
  Table& optional(const std::string& name, Member member, const Type<T>& type, const std::string& example,
                  const std::string& help) {
    std::string default_text;
    const S defaults{};
    if constexpr (std::is_convertible_v<decltype(std::invoke(member, defaults)), const T&>)
      default_text = type.write(std::invoke(member, defaults));
    return add({name, type.info, false, default_text, example, help}, member, type);
  }

  /// One of several ways to say the same: it has no default, and a then() sees to it that one way is taken.
  template <class Member, class T>
  Table& either(const std::string& name, Member member, const Type<T>& type, const std::string& example,
                const std::string& help) {
    return add({name, type.info, false, "", example, help}, member, type);
  }

  /// Names the key whose value chooses among the alternatives that follow.
  Table& chosen_by(const std::string& tag, const std::string& help) {
    info_.tag = tag;
    info_.tag_help = help;
    return *this;
  }
  /// The keys of `table` fill an A that is put into `member` (a variant) when `tag: name` stands in the map.
  template <class Member, class A>
  Table& alternative(const std::string& name, Member member, const Table<A>& table) {
    return add_alternative(name, true, member, table);
  }
  /// The same, when a key `name` stands in the map.
  template <class Member, class A>
  Table& alternative_by_key(const std::string& name, Member member, const Table<A>& table) {
    return add_alternative(name, false, member, table);
  }

  /// Run after all keys are read, in order: what depends on several keys. Throws through fail().
  Table& then(Reader check) {
    checks_.push_back(std::move(check));
    return *this;
  }

  /// Throws UserError for whatever is wrong in `map`.
  [[nodiscard]] S read(const Value& map, const std::string& path) const {
    const auto alternative = check_keys(info_, map, path);
    S out{};
    if (alternative < alternatives_.size()) alternatives_[alternative](out, map, path);
    fill(out, map, path);
    return out;
  }

  /// Reads the keys without looking for unknown ones: for tables whose keys stand among those of another.
  void fill(S& out, const Value& map, const std::string& path) const {
    for (const auto& reader : readers_) reader(out, map, path);
    for (const auto& check : checks_) check(out, map, path);
  }

  [[nodiscard]] const TableInfo& info() const { return info_; }

 private:
  template <class Member, class T>
  Table& add(KeyInfo key, Member member, const Type<T>& type) {
    readers_.push_back(
        [name = key.name, member, read = type.read](S& out, const Value& map, const std::string& path) {
          if (const auto* value = map.find(name)) std::invoke(member, out) = read(*value, join(path, name));
        });
    info_.keys.push_back(std::move(key));
    return *this;
  }

  template <class Member, class A>
  Table& add_alternative(const std::string& name, bool by_tag, Member member, const Table<A>& table) {
    info_.alternatives.push_back({name, by_tag, &table.info()});
    alternatives_.push_back([member, &table](S& out, const Value& map, const std::string& path) {
      A alternative{};
      table.fill(alternative, map, path);
      std::invoke(member, out) = std::move(alternative);
    });
    return *this;
  }

  TableInfo info_;
  std::vector<Reader> readers_;
  std::vector<Reader> checks_;
  std::vector<Reader> alternatives_;
};

/// A map with the keys of `table`, which must outlive the type.
template <class S>
[[nodiscard]] Type<S> table_of(const Table<S>& table) {
  return {.info = {.name = "keys", .shape = TypeInfo::Shape::table, .table = &table.info()},
          .read = [&table](const Value& value, const std::string& path) { return table.read(value, path); },
          .write = [](const S&) { return std::string(); }};
}

/// A map of name → table, in order; the names go into S::name.
template <class S>
[[nodiscard]] Type<std::vector<S>> named(const Table<S>& table) {
  return {.info = {.name = "name: keys", .shape = TypeInfo::Shape::named_tables, .table = &table.info()},
          .read =
              [&table](const Value& value, const std::string& path) {
                expect_map(value, path);
                std::vector<S> out;
                for (const auto& [name, entry] : value.entries) {
                  expect_name(entry, path, name);
                  out.push_back(table.read(entry, join(path, name)));
                  out.back().name = name;
                }
                return out;
              },
          .write = [](const std::vector<S>&) { return std::string(); }};
}

}  // namespace evert::schema
