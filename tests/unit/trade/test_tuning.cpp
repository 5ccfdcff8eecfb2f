#include "evert/core/error.hpp"
#include "evert/trade/tuning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace evert::trade {
namespace {

Axis axis(AxisKind kind, std::vector<double> numbers, std::size_t best) {
  Axis a{
      .key = "k", .kind = kind, .values = {}, .numbers = std::move(numbers), .overrides = {}, .best = best};
  for (const double n : a.numbers) a.values.push_back(std::to_string(n));
  a.overrides.resize(a.numbers.size());
  return a;
}

/// 48 settings: steps, edge lengths and tolerances.
const std::vector<Axis> axes{axis(AxisKind::step, {1, 2, 4, 8}, 0), axis(AxisKind::length, {1, 1.5, 2}, 0),
                             axis(AxisKind::tolerance, {1e-8, 1e-6, 1e-4, 1e-2}, 0)};

using World = std::function<Trial(const Choice&)>;

/// What a scene might do: errors of second order in step and mesh that add up as they like, a cost with a
/// share that does not depend on the step, and steps past a bound of the mesh that explode.
Trial scene(const Choice& choice) {
  const double step = axes[0].numbers[choice[0]], length = axes[1].numbers[choice[1]],
               tolerance = axes[2].numbers[choice[2]];
  Trial t{.choice = choice, .label = "", .fate = Fate::finished, .message = "", .errors = {}};
  t.errors.displacement = 2e-4 * step * step + 3e-3 * std::pow(length, 1.7) + 0.3 * tolerance;
  t.cost = (0.1 + 1 / step) * std::pow(length, -3) * (1 - 0.06 * std::log10(tolerance));
  if (step > 4.1 * length) t.fate = Fate::unstable;
  return t;
}

double best_cost(const World& world, double error) {
  double best = 1e300;
  for (const auto& choice : grid_of(axes)) {
    const auto t = world(choice);
    if (t.usable() && t.errors.displacement <= error) best = std::min(best, t.cost);
  }
  return best;
}

TradeModel tuned(const World& world, const TuningGoal& goal, std::size_t runs) {
  TradeModel model(axes);
  const auto grid = grid_of(axes);
  while (model.trials().size() < runs) {
    const auto choice = next_trial(model, axes, grid, goal);
    if (!choice) break;
    EXPECT_FALSE(model.knows(*choice)) << "runs nothing twice";
    model.add(world(*choice));
  }
  return model;
}

TEST(Tuning, FindsTheCheapestWithinAnErrorInAFifthOfTheRuns) {
  for (const double error : {0.005, 0.01, 0.02, 0.03}) {
    const TuningGoal goal{.error = error, .budget = {}};
    const auto model = tuned(scene, goal, 10);
    const auto* best = best_trial(model, goal);
    ASSERT_NE(best, nullptr) << error;
    EXPECT_LE(best->errors.displacement, error);
    EXPECT_LE(best->cost, 1.5 * best_cost(scene, error)) << error;
  }
}

TEST(Tuning, FindsTheBestWithinABudget) {
  const TuningGoal goal{.error = {}, .budget = 0.1};
  const auto model = tuned(scene, goal, 10);
  const auto* best = best_trial(model, goal);
  ASSERT_NE(best, nullptr);
  EXPECT_LE(best->cost, 0.1);
  double least = 1;
  for (const auto& choice : grid_of(axes)) {
    const auto t = scene(choice);
    if (t.usable() && t.cost <= 0.1) least = std::min(least, t.errors.displacement);
  }
  EXPECT_LE(best->errors.displacement, 1.2 * least);
}

TEST(Tuning, SaysWhenNothingIsGoodEnough) {
  const TuningGoal goal{.error = 1e-6, .budget = {}};
  EXPECT_EQ(best_trial(tuned(scene, goal, 12), goal), nullptr);
}

TEST(Tuning, DoesNotTryWhatMustExplode) {
  TradeModel model(axes);
  model.add(scene({0, 0, 0}));
  model.add(scene({1, 0, 0}));
  model.add(scene({3, 0, 0}));
  ASSERT_FALSE(model.trials().back().usable());
  EXPECT_FALSE(model.predict({3, 0, 2}));
  EXPECT_FALSE(model.predict({3, 1, 0})) << "hardly any coarser";
  EXPECT_TRUE(model.predict({3, 2, 0})) << "a coarser mesh allows a longer step";
  EXPECT_TRUE(model.predict({2, 0, 0}));
}

TEST(Tuning, ChoicesAreAllRunAndNotGuessed) {
  const std::vector<Axis> words{axis(AxisKind::choice, {std::nan(""), std::nan(""), std::nan("")}, 0)};
  TradeModel model(words);
  const TuningGoal goal{.error = 0.1, .budget = {}};
  int runs = 0;
  for (; const auto choice = next_trial(model, words, grid_of(words), goal); ++runs) {
    Trial t{.choice = *choice,
            .label = "",
            .fate = Fate::finished,
            .message = "",
            .cost = 3.0 - runs,
            .errors = {}};
    t.errors.displacement = 0.01;
    model.add(t);
  }
  EXPECT_EQ(runs, 3);
  EXPECT_EQ(best_trial(model, goal)->cost, 1);
}

TEST(Tuning, SharesAreReadAsPercentOrNumbers) {
  EXPECT_EQ(parse_share("error", "1%"), 0.01);
  EXPECT_EQ(parse_share("error", "0.05"), 0.05);
  for (const auto* wrong : {"", "0", "-1%", "x", "1 %", "1%%", "inf"})
    EXPECT_THROW(static_cast<void>(parse_share("error", wrong)), UserError) << wrong;
}

}  // namespace
}  // namespace evert::trade
