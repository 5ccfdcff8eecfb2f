#pragma once
#include "evert/trade/comparison.hpp"
#include "evert/trade/variation.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace evert::trade {

/// A setting of the sweep, what it costs and how wrong it is.
struct Trial {
  Choice choice;
  std::string label;
  Fate fate = Fate::finished;
  std::string message;
  double cost = 0;    ///< processor seconds of all ranks per simulated second [-]
  double memory = 0;  ///< [bytes]
  double steps = 0;
  double nodes = 0;
  Errors errors;  ///< where it finished

  [[nodiscard]] bool usable() const { return fate == Fate::finished; }
};

/// Indices of the usable trials that no other beats in both cost and error of the displacement, the cheapest
/// first. Less than a hundredth of the error is no gain: who is dearer for that is left out.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const Trial> trials);

/// All trials by cost, the front marked, as a table for people.
[[nodiscard]] std::string table_of(std::span<const Trial> trials, std::span<const std::size_t> front);
/// The same as CSV, a column for each axis.
[[nodiscard]] std::string csv_of(std::span<const Axis> axes, std::span<const Trial> trials,
                                 std::span<const std::size_t> front);

/// An SVG page: error over cost, both logarithmic; the front numbered, with a list of what the numbers are.
/// `reference_error` is drawn as a line below which errors say nothing.
[[nodiscard]] std::string plot_of(const std::string& title, std::span<const Trial> trials,
                                  std::span<const std::size_t> front, double reference_error);

/// "1.2 %".
[[nodiscard]] std::string percent(double share);

}  // namespace evert::trade
