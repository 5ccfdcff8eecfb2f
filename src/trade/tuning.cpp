#include "evert/trade/tuning.hpp"

#include "evert/core/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

namespace evert::trade {
namespace {

constexpr double tiny = 1e-12;  // errors of nothing

/// Powers of the value that error and cost go with, until two runs say more.
Prediction usual_powers(AxisKind kind) {
  switch (kind) {
    case AxisKind::step:
      return {2, -1};
    case AxisKind::length:
      return {2, -4};
    case AxisKind::count:
      return {-2.0 / 3, 4.0 / 3};
    case AxisKind::tolerance:
      return {1, -0.05};
    case AxisKind::choice:
      break;
  }
  return {0, 0};
}

/// Through (x1, y1) and (x2, y2), all logarithms.
double on_line(double x1, double y1, double x2, double y2, double x) {
  return y1 + (y2 - y1) * (x - x1) / (x2 - x1);
}

double distance(const Choice& a, const Choice& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
  return sum;
}

}  // namespace

void TradeModel::add(const Trial& trial) { trials_.push_back(trial); }

const Trial* TradeModel::find(const Choice& choice) const {
  const auto found = std::ranges::find(trials_, choice, &Trial::choice);
  return found == trials_.end() ? nullptr : &*found;
}

bool TradeModel::knows(const Choice& choice) const { return find(choice) != nullptr; }

Choice TradeModel::base() const {
  Choice choice;
  for (const auto& axis : axes_) choice.push_back(axis.best);
  return choice;
}

Choice TradeModel::varied(std::size_t axis, std::size_t value) const {
  auto choice = base();
  choice[axis] = value;
  return choice;
}

std::optional<Prediction> TradeModel::measured_effect(std::size_t axis, std::size_t value) const {
  const auto* at_base = find(base());
  if (at_base == nullptr || !at_base->usable()) return std::nullopt;
  // Of the error of the base nobody knows whose it is.
  const double own = std::pow(at_base->errors.displacement, 2) / static_cast<double>(axes_.size());
  if (value == axes_[axis].best) return Prediction{std::max(std::sqrt(own), tiny), 1};
  const auto* trial = find(varied(axis, value));
  if (trial == nullptr || !trial->usable()) return std::nullopt;
  const double others = std::pow(at_base->errors.displacement, 2) - own;
  const double square = std::pow(trial->errors.displacement, 2) - others;
  return Prediction{std::sqrt(std::max(square, tiny * tiny)), trial->cost / at_base->cost};
}

std::optional<Prediction> TradeModel::effect(std::size_t axis, std::size_t value) const {
  if (const auto measured = measured_effect(axis, value)) return measured;
  const auto& numbers = axes_[axis].numbers;
  if (axes_[axis].kind == AxisKind::choice || std::isnan(numbers[value])) return std::nullopt;
  struct Known {
    double x;
    Prediction effect;
  };
  std::vector<Known> known;
  const double x = std::log(numbers[value]);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (const auto measured = std::isnan(numbers[i]) ? std::nullopt : measured_effect(axis, i))
      known.push_back({std::log(numbers[i]), *measured});
  if (known.empty()) return std::nullopt;
  std::ranges::sort(known, {}, [&](const Known& k) { return std::abs(k.x - x); });
  const auto& near = known.front();
  if (known.size() == 1) {
    const auto powers = usual_powers(axes_[axis].kind);
    return Prediction{near.effect.error * std::exp(powers.error * (x - near.x)),
                      near.effect.cost * std::exp(powers.cost * (x - near.x))};
  }
  // Between two of them rather than beyond.
  const auto across =
      std::ranges::find_if(known, [&](const Known& k) { return (k.x - x) * (near.x - x) < 0; });
  const auto& other = across == known.end() ? known[1] : *across;
  const auto line = [&](double a, double b) {
    return std::exp(on_line(near.x, std::log(a), other.x, std::log(b), x));
  };
  return Prediction{line(near.effect.error, other.effect.error), line(near.effect.cost, other.effect.cost)};
}

std::optional<Prediction> TradeModel::separable(const Choice& choice) const {
  const auto* at_base = find(base());
  if (at_base == nullptr || !at_base->usable()) return std::nullopt;
  double square = 0, cost = at_base->cost;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const auto part = effect(a, choice[a]);
    if (!part) return std::nullopt;
    square += part->error * part->error;
    cost *= part->cost;
  }
  return Prediction{std::sqrt(square), cost};
}

double TradeModel::quickness(const Choice& choice) const {
  double quick = 1;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const double number = axes_[a].numbers[choice[a]];
    if (std::isnan(number)) continue;
    if (axes_[a].kind == AxisKind::step) quick *= number;
    if (axes_[a].kind == AxisKind::length) quick /= number;
    if (axes_[a].kind == AxisKind::count) quick *= std::cbrt(number);
  }
  return quick;
}

bool TradeModel::should_fail(const Choice& choice) const {
  double held = 0, failed = std::numeric_limits<double>::infinity();
  for (const auto& trial : trials_)
    if (trial.usable())
      held = std::max(held, quickness(trial.choice));
    else if (trial.fate == Fate::unstable)
      failed = std::min(failed, quickness(trial.choice));
  if (std::isinf(failed)) return false;
  // Between the two lies the limit: two thirds of the way, in logarithms, are worth a try.
  return !(quickness(choice) < std::max(held, std::cbrt(held * failed * failed)) * (1 + tiny));
}

std::optional<Prediction> TradeModel::predict(const Choice& choice) const {
  if (const auto* trial = find(choice))
    return trial->usable() ? std::optional(Prediction{trial->errors.displacement, trial->cost})
                           : std::nullopt;
  if (should_fail(choice)) return std::nullopt;
  auto guess = separable(choice);
  if (!guess) return std::nullopt;
  double weights = 0, error = 0, cost = 0;
  for (const auto& trial : trials_) {
    const auto missed = trial.usable() ? separable(trial.choice) : std::nullopt;
    if (!missed || trial.errors.displacement <= 0 || trial.cost <= 0) continue;
    const double weight = std::pow(0.25, distance(choice, trial.choice));
    weights += weight;
    error += weight * std::log(trial.errors.displacement / missed->error);
    cost += weight * std::log(trial.cost / missed->cost);
  }
  if (weights > 0) {
    guess->error *= std::exp(error / weights);
    guess->cost *= std::exp(cost / weights);
  }
  return guess;
}

const Trial* best_trial(const TradeModel& model, const TuningGoal& goal) {
  const Trial* best = nullptr;
  const auto objective = [&](const Trial& t) { return goal.objective(t.errors.displacement, t.cost); };
  for (const auto& trial : model.trials())
    if (trial.usable() && goal.is_met(trial.errors.displacement, trial.cost) &&
        (best == nullptr || objective(trial) < objective(*best)))
      best = &trial;
  return best;
}

namespace {

/// A value of an axis that should be run by itself: of a choice every one, else the cheapest, and where that
/// does not finish, what is half-way to the best.
std::optional<Choice> next_of_axis(const TradeModel& model, const Axis& axis, std::size_t a) {
  std::vector<std::size_t> order;  // the cheapest first
  for (std::size_t i = 0; i < axis.size(); ++i)
    if (i != axis.best) order.push_back(i);
  std::ranges::stable_sort(order, [&](std::size_t i, std::size_t j) { return axis.is_coarser(i, j); });
  const auto trial_of = [&](std::size_t value) {
    return std::ranges::find(model.trials(), model.varied(a, value), &Trial::choice);
  };
  for (std::size_t from = 0; from < order.size();) {
    const auto trial = trial_of(order[from]);
    if (trial == model.trials().end()) return model.varied(a, order[from]);
    const bool each = axis.kind == AxisKind::choice || std::isnan(axis.numbers[order[from]]);
    if (!each && trial->usable()) return std::nullopt;
    from += each ? 1 : (order.size() - from + 1) / 2;
  }
  return std::nullopt;
}

/// What is to be small, larger the more the goal is missed: a guess that misses it a little may be wrong.
double promise(const Prediction& guess, const TuningGoal& goal) {
  constexpr double severity = 3;
  const double miss = goal.error ? guess.error / *goal.error : guess.cost / *goal.budget;
  return goal.objective(guess.error, guess.cost) * std::pow(std::max(1.0, miss), severity);
}

/// Guesses miss what axes do together: a neighbour of the best that should be worse by a half may be better,
/// and another word by more.
std::optional<Choice> near_best(const TradeModel& model, std::span<const Axis> axes, const Trial& best,
                                const TuningGoal& goal) {
  constexpr double doubt = 1.5, doubt_of_words = 3;
  const double now = goal.objective(best.errors.displacement, best.cost);
  double least = std::numeric_limits<double>::infinity();
  std::optional<Choice> next;
  for (std::size_t a = 0; a < axes.size(); ++a)
    for (std::size_t value = 0; value < axes[a].size(); ++value) {
      auto choice = best.choice;
      choice[a] = value;
      const auto guess = model.knows(choice) ? std::nullopt : model.predict(choice);
      if (!guess || !goal.is_met(guess->error / doubt, guess->cost / doubt)) continue;
      const double objective = goal.objective(guess->error, guess->cost);
      const double most = now * (axes[a].kind == AxisKind::choice ? doubt_of_words : doubt);
      if (objective >= std::min(most, least)) continue;
      least = objective;
      next = choice;
    }
  return next;
}

}  // namespace

std::optional<Choice> next_trial(const TradeModel& model, std::span<const Axis> axes,
                                 std::span<const Choice> grid, const TuningGoal& goal) {
  if (!model.knows(model.base())) return model.base();
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (const auto choice = next_of_axis(model, axes[a], a)) return choice;
  const auto* best = best_trial(model, goal);
  constexpr double worth_a_run = 0.95;
  double to_beat = std::numeric_limits<double>::infinity();
  if (best != nullptr) to_beat = worth_a_run * goal.objective(best->errors.displacement, best->cost);
  std::optional<Choice> next;
  for (const auto& choice : grid) {
    const auto guess = model.knows(choice) ? std::nullopt : model.predict(choice);
    if (!guess || promise(*guess, goal) >= to_beat) continue;
    to_beat = promise(*guess, goal);
    next = choice;
  }
  return next || best == nullptr ? next : near_best(model, axes, *best, goal);
}

double parse_share(const std::string& option, const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  const bool is_percent = error == std::errc{} && next + 1 == end && *next == '%';
  if (error != std::errc{} || (next != end && !is_percent) || !(number > 0) || !std::isfinite(number))
    throw UserError("-" + option + ": must be a positive number like 1% or 0.01, not '" + text + "'");
  return is_percent ? number / 100 : number;
}

}  // namespace evert::trade
