#include "evert/app/run_loop.hpp"
#include "evert/app/trade_command.hpp"
#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/io/files.hpp"

#include "trade_study.hpp"
#include <algorithm>
#include <cmath>

namespace evert {
namespace {

/// Runs that may be made besides the reference: with it a quarter of those of the whole sweep, but enough to
/// see each axis and to look at one combination.
std::size_t most_trials(const TradeStudy& study) {
  constexpr std::size_t of_reference = 2;  // its coarsest run is one of the grid
  const std::size_t whole = study.grid().size() + of_reference;
  std::size_t needed = 2;
  for (const auto& axis : study.axes()) needed += axis.kind == trade::AxisKind::choice ? axis.size() - 1 : 1;
  return std::max(needed, whole / 4 > of_reference ? whole / 4 - of_reference : 0);
}

std::string goal_text(const trade::TuningGoal& goal) {
  return goal.error ? "an error of " + trade::percent(*goal.error)
                    : formatted("a budget of %.3g CPU s per s", *goal.budget);
}

/// Against the best values of all axes: what each choice does by itself.
std::string effects_text(const TradeStudy& study, const trade::TradeModel& model,
                         const trade::Choice& choice) {
  const auto base = model.predict(model.base());
  std::string text, best_key;
  double best_gain = 1;
  for (std::size_t a = 0; a < study.axes().size(); ++a) {
    const auto& axis = study.axes()[a];
    const auto alone = model.predict(model.varied(a, choice[a]));
    if (!base || !alone || choice[a] == axis.best) continue;
    const double gain = base->cost / alone->cost;
    text += formatted("  %s %s instead of %s: %.2g times the speed, an error of %s instead of %s\n",
                      axis.key.c_str(), axis.values[choice[a]].c_str(), axis.values[axis.best].c_str(), gain,
                      trade::percent(alone->error).c_str(), trade::percent(base->error).c_str());
    if (gain > best_gain) {
      best_gain = gain;
      best_key = axis.key;
    }
  }
  if (!best_key.empty()) text += "  " + best_key + " buys most\n";
  return text;
}

/// Collective. Runs what promises most until nothing does. False: a signal came.
bool search(TradeStudy& study, trade::TradeModel& model, const trade::TuningGoal& goal) {
  const auto most = most_trials(study);
  while (model.trials().size() < most) {
    const auto choice = next_trial(model, study.axes(), study.grid(), goal);
    if (!choice) return true;
    const auto trial = study.run(*choice, 1);
    if (!trial) return false;
    model.add(*trial);
    study.say_detail(formatted("run %zu: ", model.trials().size()) + trial->label + ": " +
                     (trial->usable() ? formatted("%.3g CPU s per s, error ", trial->cost) +
                                            trade::percent(trial->errors.displacement)
                                      : std::string(name_of(trial->fate))) +
                     "\n");
  }
  return true;
}

/// The trial that comes nearest to the goal, for a message.
std::string nearest_text(const trade::TradeModel& model, const trade::TuningGoal& goal) {
  const trade::Trial* nearest = nullptr;
  const auto miss = [&](const trade::Trial& t) { return goal.error ? t.errors.displacement : t.cost; };
  for (const auto& trial : model.trials())
    if (trial.usable() && (nearest == nullptr || miss(trial) < miss(*nearest))) nearest = &trial;
  if (nearest == nullptr) return "none finished";
  return "the nearest is " + nearest->label +
         formatted(" with %.3g CPU s per s and an error of ", nearest->cost) +
         trade::percent(nearest->errors.displacement);
}

std::string tuned_scene(const TradeStudy& study, const trade::Trial& trial, const std::string& goal) {
  return "# " + study.name() + " with " + trial.label + ", chosen by evert tune for " + goal + "\n" +
         "# Same as: " + study.command_of(trial.choice) + "\n" +
         study.source().yaml(trade::overrides_of(study.axes(), trial.choice), study.directory());
}

}  // namespace

int tune_command(MPI_Comm comm, const TradeArguments& arguments, std::ostream& out) {
  if (arguments.help) {
    if (rank_of(comm) == 0) out << tune_usage();
    return 0;
  }
  catch_signals();
  TradeStudy study(comm, arguments, out);
  if (!study.make_reference()) return interrupted_trade(comm, study);
  if (arguments.goal.error && study.quality().most > *arguments.goal.error)
    study.say("note: the finest run itself may be wrong by more than the error that is asked for\n");
  trade::TradeModel model(study.axes());
  if (!search(study, model, arguments.goal)) return interrupted_trade(comm, study);
  const auto goal = goal_text(arguments.goal);
  const auto* best = best_trial(model, arguments.goal);
  if (best == nullptr)
    throw SimulationError("no setting was found within " + goal + ": " + nearest_text(model, arguments.goal) +
                          "; give finer or cheaper values with -vary");
  on_root(comm, [&] { write_file(study.path("tuned.yaml"), tuned_scene(study, *best, goal)); });
  study.say("\nwithin " + goal + ": " + best->label + formatted(": %.3g CPU s per s, error ", best->cost) +
            trade::percent(best->errors.displacement) + "\n" + effects_text(study, model, best->choice));
  study.say(formatted("  %zu settings of %zu run\n", model.trials().size(), study.grid().size()) + "  " +
            study.command_of(best->choice) + "\n  written to " + study.path("tuned.yaml") + "\n");
  return 0;
}

}  // namespace evert
