#include "setting_values.hpp"

#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

namespace evert::trade {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double plain_number(std::string_view text) {
  double number = none;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() ? number : none;
}

/// The text with each of its numbers replaced.
template <class Change>
std::string with_numbers(const std::string& text, Change change) {
  std::string out;
  for (const char* at = text.data(); at != text.data() + text.size();) {
    double number = 0;
    const auto [end, error] = std::from_chars(at, text.data() + text.size(), number);
    const bool begins_here = error == std::errc{} && (out.empty() || std::isalnum(out.back()) == 0);
    if (begins_here) {
      out += change(number);
      at = end;
    } else {
      out += *at++;
    }
  }
  return out;
}

std::string count_text(double count) { return formatted("%.0f", std::max(1.0, std::round(count))); }

bool is_multiple(const std::string& value) {
  return value.size() > 1 && value[0] == 'x' && !std::isnan(plain_number(value.substr(1)));
}

/// A multiple of what the scene has at `path`.
std::string scaled(const SceneSource& scene, const std::string& path, double factor,
                   const Automatic& automatic) {
  auto base = scene.value_at(path);
  if (!base || *base == "auto") {
    const auto found = automatic.find(path);
    if (found == automatic.end())
      throw UserError("-vary " + path + ": x" + formatted("%g", factor) +
                      " is a multiple of what the scene has, but it has nothing there");
    base = formatted("%.6g", found->second);
  }
  const bool counts = base->front() == '[' || path.ends_with(".cells");
  return with_numbers(*base, [&](double number) {
    return counts ? count_text(factor * number) : formatted("%.6g", factor * number);
  });
}

/// The ways to say the same: the first that the scene can have is meant.
std::vector<Overrides> ways_to_say(const std::string& path, const std::string& value) {
  const auto ends = [&](std::string_view key) { return path.ends_with(key); };
  const auto beside = [&](std::size_t cut, const std::string& key) {
    return path.substr(0, path.size() - cut) + key;
  };
  const auto plain = path + "=" + value;
  if (ends(".mesh.edge_length")) return {{plain}, {beside(11, "cells=null"), plain}};
  if (ends(".mesh.cells")) return {{plain}, {beside(5, "edge_length=null"), plain}};
  if (!ends(".mesh.element")) return {{plain}};
  const auto cell = beside(7, "cell="), order = beside(12, "order=");
  if (value == "tet4") return {{cell + "tet6", order + "1"}, {order + "1"}};
  if (value == "tet10") return {{cell + "tet6", order + "2"}, {order + "2"}};
  return {{cell + value, order + "1"}};
}

/// "-set a.b" becomes "-vary a.b" in what the scene says of an override.
std::string as_variation(std::string message) {
  return message.starts_with("-set ") ? "-vary" + message.substr(4) : message;
}

void require_known_element(const std::string& key, const std::string& value) {
  static const std::vector<std::string> elements{"tet4", "tet10", "hex8", "wedge6", "bcc", "tet5", "tet6"};
  if (!key.ends_with(".mesh.element") || std::ranges::find(elements, value) != elements.end()) return;
  throw UserError("-vary " + key + ": there is no element '" + value + "': must be " + list_of(elements) +
                  did_you_mean(value, elements));
}

/// Empty, with the reason in `refusal`, where the scene cannot have it.
Overrides overrides_at(const SceneSource& scene, const std::string& path, const std::string& value,
                       const Automatic& automatic, std::string& refusal) {
  try {
    const auto meant =
        is_multiple(value) ? scaled(scene, path, plain_number(value.substr(1)), automatic) : value;
    for (const auto& way : ways_to_say(path, meant)) {
      try {
        static_cast<void>(scene.variant(way));
        return way;
      } catch (const UserError& error) {
        if (refusal.empty()) refusal = error.what();
      }
    }
  } catch (const UserError& error) {
    if (refusal.empty()) refusal = error.what();
  }
  return {};
}

/// The paths that a key with a `*` may mean.
std::vector<std::string> expanded(const SceneSource& scene, const std::string& key) {
  const auto star = key.find("*");
  if (star == std::string::npos) return {key};
  std::vector<std::string> paths;
  const auto names = star > 1 ? scene.names_at(key.substr(0, star - 1)) : std::vector<std::string>{};
  for (const auto& name : names) paths.push_back(key.substr(0, star) + name + key.substr(star + 1));
  if (paths.empty())
    throw UserError("-vary " + key +
                    ": the scene has nothing that * could stand for; it stands for names, as "
                    "in bodies.*.mesh.edge_length");
  return paths;
}

}  // namespace

double number_of(const std::string& value) {
  if (is_multiple(value)) return plain_number(value.substr(1));
  if (value.empty() || value.front() != '[') return plain_number(value);
  double product = 1;
  with_numbers(value, [&](double number) {
    product *= number;
    return std::string();
  });
  return product;
}

std::string refined(const std::string& value, AxisKind kind, double factor, int times) {
  if (kind == AxisKind::choice || std::isnan(number_of(value))) return value;
  const bool multiple = is_multiple(value);
  const auto change = [&](double number) {
    if (kind == AxisKind::tolerance)
      return formatted(
          "%.6g", multiple ? number * std::pow(0.1, times) : std::max(1e-13, number * std::pow(0.1, times)));
    if (kind == AxisKind::count)
      return multiple ? formatted("%.9g", number * factor) : count_text(number * factor);
    return formatted("%.9g", number / factor);
  };
  return multiple ? "x" + change(plain_number(value.substr(1))) : with_numbers(value, change);
}

Overrides overrides_for(const SceneSource& scene, const std::string& key, const std::string& value,
                        const Automatic& automatic) {
  require_known_element(key, value);
  Overrides all;
  std::string refusal;
  for (const auto& path : expanded(scene, key)) {
    const auto way = overrides_at(scene, path, value, automatic, refusal);
    all.insert(all.end(), way.begin(), way.end());
  }
  if (all.empty()) throw UserError(as_variation(refusal));
  return all;
}

std::vector<std::string> paths_of(const Overrides& overrides) {
  std::vector<std::string> paths;
  for (const auto& text : overrides) paths.push_back(text.substr(0, text.find('=')));
  return paths;
}

}  // namespace evert::trade
