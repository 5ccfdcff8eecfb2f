#pragma once
#include "evert/trade/front.hpp"

#include <optional>
#include <set>
#include <vector>

namespace evert::trade {

/// What is wanted of a setting: the least cost within an error, or the least error within a cost.
struct TuningGoal {
  std::optional<double> error;   ///< [-] of the displacement
  std::optional<double> budget;  ///< [-] processor seconds per simulated second

  [[nodiscard]] bool is_met(double error_found, double cost_found) const {
    return error ? error_found <= *error : cost_found <= *budget;
  }
  /// What is to be small once the goal is met.
  [[nodiscard]] double objective(double error_found, double cost_found) const {
    return error ? cost_found : error_found;
  }
};

/// A guess at a setting that was not run.
struct Prediction {
  double error = 0;  ///< [-]
  double cost = 0;   ///< [-]
};

/// What the runs so far say about all settings: squares of the errors that axes make add up, factors of cost
/// multiply, both powers of the values; where a combination was run, its neighbours are corrected by what the
/// guess missed there.
class TradeModel {
 public:
  explicit TradeModel(std::span<const Axis> axes) : axes_(axes.begin(), axes.end()) {}

  void add(const Trial& trial);
  [[nodiscard]] bool knows(const Choice& choice) const;
  /// Empty: nothing can be said yet, or it should be unstable, as others with such steps for such edges were.
  [[nodiscard]] std::optional<Prediction> predict(const Choice& choice) const;
  [[nodiscard]] const std::vector<Trial>& trials() const { return trials_; }
  /// The best values of all axes.
  [[nodiscard]] Choice base() const;
  /// The base with one axis at another value.
  [[nodiscard]] Choice varied(std::size_t axis, std::size_t value) const;

 private:
  [[nodiscard]] const Trial* find(const Choice& choice) const;
  /// Error that one value of an axis makes, and what it multiplies the cost of the base by. Empty: unknown.
  [[nodiscard]] std::optional<Prediction> effect(std::size_t axis, std::size_t value) const;
  [[nodiscard]] std::optional<Prediction> measured_effect(std::size_t axis, std::size_t value) const;
  [[nodiscard]] std::optional<Prediction> separable(const Choice& choice) const;
  /// Steps over lengths of edges: what stability limits, in some unit.
  [[nodiscard]] double quickness(const Choice& choice) const;
  [[nodiscard]] bool should_fail(const Choice& choice) const;

  std::vector<Axis> axes_;
  std::vector<Trial> trials_;
};

/// The next setting to run: first the base and each axis by itself, then what promises to meet the goal
/// better than all so far, then neighbours of the best that might, for all that is known. Empty: none does.
[[nodiscard]] std::optional<Choice> next_trial(const TradeModel& model, std::span<const Axis> axes,
                                               std::span<const Choice> grid, const TuningGoal& goal);

/// The best trial that meets the goal; nullptr: none does.
[[nodiscard]] const Trial* best_trial(const TradeModel& model, const TuningGoal& goal);

/// "5%" or "0.05" as 0.05. Throws UserError, with `option` in it, for what is no positive number.
[[nodiscard]] double parse_share(const std::string& option, const std::string& text);

}  // namespace evert::trade
