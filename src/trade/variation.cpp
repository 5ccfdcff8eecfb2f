#include "evert/trade/variation.hpp"

#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"

#include "setting_values.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace evert::trade {
namespace {

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

/// At commas outside of brackets and quotes.
std::vector<std::string> split_values(const std::string& text) {
  std::vector<std::string> values(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0)
      quote = c == quote ? char(0) : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '[' || c == '{')
      ++depth;
    else if (c == ']' || c == '}')
      --depth;
    if (c == ',' && depth == 0 && quote == 0)
      values.emplace_back();
    else if (c != ' ' || quote != 0 || depth != 0)
      values.back() += c;
  }
  return values;
}

AxisKind kind_of(const std::string& key) {
  const auto name = last_part(key);
  const auto is = [&](auto... names) { return ((name == names) || ...); };
  if (is("time_step", "max_strain_increment") || key == "integrator.safety") return AxisKind::step;
  if (is("edge_length")) return AxisKind::length;
  if (is("cells", "quarter", "rings", "layers")) return AxisKind::count;
  if (name.ends_with("rtol") || name.ends_with("atol") || name.ends_with("_tol")) return AxisKind::tolerance;
  return AxisKind::choice;
}

/// The value of a choice that is nearest to the truth, where that is known; else the first.
std::size_t best_choice(const std::string& key, const std::vector<std::string>& values) {
  constexpr std::array better{"tet10", "2", "hex8", "wedge6", "null"};
  const auto name = last_part(key);
  if (name != "element" && name != "cell" && name != "order" && key != "filter") return 0;
  for (const auto* word : better)
    if (const auto found = std::ranges::find(values, word); found != values.end())
      return static_cast<std::size_t>(found - values.begin());
  return 0;
}

std::size_t best_of(const Axis& axis) {
  if (axis.kind == AxisKind::choice) return best_choice(axis.key, axis.values);
  std::size_t best = 0;
  for (std::size_t i = 1; i < axis.size(); ++i)
    if (std::isnan(axis.numbers[best]) || axis.is_coarser(best, i)) best = i;
  return best;
}

}  // namespace

Variation parse_variation(const std::string& text) {
  const auto equals = text.find('=');
  const auto wrong = [&](const std::string& what) {
    throw UserError("-vary " + text + ": " + what + ", e.g. -vary integrator.time_step=1e-4,2e-4");
  };
  if (equals == std::string::npos || equals == 0) wrong("must be key=value,value");
  Variation variation{text.substr(0, equals), split_values(text.substr(equals + 1))};
  auto sorted = variation.values;
  std::ranges::sort(sorted);
  if (sorted.front().empty()) wrong("has an empty value");
  if (std::ranges::adjacent_find(sorted) != sorted.end()) wrong("has a value twice");
  return variation;
}

bool Axis::is_coarser(std::size_t i, std::size_t j) const {
  if (kind == AxisKind::choice || std::isnan(numbers[i]) || std::isnan(numbers[j])) return false;
  return kind == AxisKind::count ? numbers[i] < numbers[j] : numbers[i] > numbers[j];
}

Axis resolve(const SceneSource& scene, const Variation& variation, const Automatic& automatic) {
  Axis axis{.key = variation.key,
            .kind = kind_of(variation.key),
            .values = variation.values,
            .numbers = {},
            .overrides = {}};
  for (const auto& value : axis.values) {
    axis.numbers.push_back(number_of(value));
    axis.overrides.push_back(overrides_for(scene, axis.key, value, automatic));
  }
  for (std::size_t i = 1; i < axis.size(); ++i)
    if (paths_of(axis.overrides[i]) != paths_of(axis.overrides[0]) && axis.kind != AxisKind::choice)
      throw UserError("-vary " + axis.key + ": not every body that may have " + axis.values[0] +
                      " may have " + axis.values[i]);
  axis.best = best_of(axis);
  return axis;
}

std::vector<Choice> grid_of(std::span<const Axis> axes) {
  constexpr std::size_t most = 10'000;
  std::vector<Choice> grid{Choice(axes.size(), 0)};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    std::vector<Choice> longer;
    for (const auto& choice : grid)
      for (std::size_t i = 0; i < axes[a].size(); ++i) {
        longer.push_back(choice);
        longer.back()[a] = i;
      }
    grid = std::move(longer);
    if (grid.size() > most)
      throw UserError("-vary: more than 10000 settings; leave out values or -vary options");
  }
  return grid;
}

Overrides overrides_of(std::span<const Axis> axes, const Choice& choice) {
  Overrides all;
  for (std::size_t a = 0; a < axes.size(); ++a)
    all.insert(all.end(), axes[a].overrides[choice[a]].begin(), axes[a].overrides[choice[a]].end());
  return all;
}

std::string label_of(std::span<const Axis> axes, const Choice& choice) {
  std::string label;
  for (std::size_t a = 0; a < axes.size(); ++a)
    label += (a > 0 ? ", " : "") + last_part(axes[a].key) + " " + axes[a].values[choice[a]];
  return label;
}

Overrides reference_of(const SceneSource& scene, std::span<const Axis> axes, const Automatic& automatic,
                       int times, double ratio, const Overrides& more) {
  Overrides all;
  for (const auto& axis : axes) {
    const auto& value = axis.values[axis.best];
    const auto finer =
        times == 0 ? axis.overrides[axis.best]
                   : overrides_for(scene, axis.key, refined(value, axis.kind, std::pow(ratio, times), times),
                                   automatic);
    all.insert(all.end(), finer.begin(), finer.end());
  }
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

double refinement_ratio(std::span<const Axis> axes) {
  const auto has = [&](AxisKind kind) {
    return std::ranges::any_of(axes, [&](const Axis& axis) { return axis.kind == kind; });
  };
  return has(AxisKind::length) && !has(AxisKind::count) ? std::sqrt(2.0) : 2.0;
}

}  // namespace evert::trade
