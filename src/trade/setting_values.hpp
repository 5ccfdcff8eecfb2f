#pragma once
#include "evert/trade/variation.hpp"

#include <string>
#include <vector>

/// Values of settings as text: what they are in numbers, finer ones, and the overrides that they stand for.
namespace evert::trade {

/// Of "1e-4" the number, of "x2" the multiple, of a list of numbers their product; NaN for other words.
[[nodiscard]] double number_of(const std::string& value);

/// `value` refined: divided by `factor` (step, length), multiplied by it (count), times 0.1 a refinement and
/// at least 1e-13 (tolerance); as it is (choice, words).
[[nodiscard]] std::string refined(const std::string& value, AxisKind kind, double factor, int times);

/// The overrides that make the value of a key, which may have a `*`. Throws UserError where there are none.
[[nodiscard]] Overrides overrides_for(const SceneSource& scene, const std::string& key,
                                      const std::string& value, const Automatic& automatic);

/// What stands before the = of each.
[[nodiscard]] std::vector<std::string> paths_of(const Overrides& overrides);

}  // namespace evert::trade
