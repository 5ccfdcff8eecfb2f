#include "evert/app/trade_command.hpp"

#include "evert/app/run_loop.hpp"
#include "evert/core/collective.hpp"
#include "evert/core/formatted.hpp"
#include "evert/io/files.hpp"

#include "trade_study.hpp"
#include <algorithm>

namespace evert {
namespace {

/// Short runs are timed more often.
int rounds_of(const TradeArguments& arguments, const trade::Trial& trial, double end_time) {
  constexpr double short_run = 30;  // s of the processor
  return arguments.repeat.value_or(trial.cost * end_time < short_run ? 2 : 1);
}

std::string line_of(const trade::Trial& trial) {
  if (!trial.usable()) return formatted("%s: %s", name_of(trial.fate), trial.message.c_str());
  return formatted("%.3g CPU s per s, error %s", trial.cost,
                   trade::percent(trial.errors.displacement).c_str());
}

/// Collective. All settings once, then again where they are timed more often: what the machine does beside
/// is then spread over all. Empty: a signal came.
std::vector<trade::Trial> run_all(TradeStudy& study, const TradeArguments& arguments) {
  std::vector<trade::Trial> trials;
  const double end_time = study.source().variant().end_time;
  for (std::size_t i = 0; i < study.grid().size(); ++i) {
    const auto trial = study.run(study.grid()[i], 1);
    if (!trial) return {};
    trials.push_back(*trial);
    study.say_detail(formatted("%3zu of %zu: ", i + 1, study.grid().size()) + trial->label + ": " +
                     line_of(*trial) + "\n");
  }
  const int most = arguments.repeat.value_or(2);
  for (int round = 2; round <= most; ++round)
    for (auto& trial : trials) {
      if (!trial.usable() || rounds_of(arguments, trial, end_time) < round) continue;
      const auto again = study.run(trial.choice, round);
      if (!again) return {};
      trial = *again;
    }
  return trials;
}

std::string front_scene(const TradeStudy& study, const trade::Trial& trial) {
  return "# " + study.name() + " with " + trial.label + "\n" +
         formatted("# %.3g CPU s per simulated s, error of the displacement %s, as evert trade found\n",
                   trial.cost, trade::percent(trial.errors.displacement).c_str()) +
         "# Same as: " + study.command_of(trial.choice) + "\n" +
         study.source().yaml(trade::overrides_of(study.axes(), trial.choice), study.directory());
}

void write_results(const TradeStudy& study, const std::vector<trade::Trial>& trials,
                   const std::vector<std::size_t>& front) {
  write_file(study.path("trade.csv"), trade::csv_of(study.axes(), trials, front));
  write_file(study.path("trade.svg"),
             trade::plot_of(study.name() + ": error against cost", trials, front, study.quality().error));
  for (std::size_t f = 0; f < front.size(); ++f)
    write_file(study.path("front_" + std::to_string(f + 1) + ".yaml"), front_scene(study, trials[front[f]]));
}

}  // namespace

int trade_command(MPI_Comm comm, const TradeArguments& arguments, std::ostream& out) {
  if (arguments.help) {
    if (rank_of(comm) == 0) out << trade_usage();
    return 0;
  }
  catch_signals();
  TradeStudy study(comm, arguments, out);
  if (!study.make_reference()) return interrupted_trade(comm, study);
  const auto trials = run_all(study, arguments);
  if (trials.empty()) return interrupted_trade(comm, study);
  const auto front = trade::pareto_front(trials);
  on_root(comm, [&] { write_results(study, trials, front); });
  study.say("\n" + trade::table_of(trials, front) + "\n");
  study.say(
      formatted("%d simulations made, %zu settings on the front, written to %s: trade.csv, trade.svg, "
                "front_1.yaml, ...\n",
                study.runs_made(), front.size(), study.directory().c_str()));
  return 0;
}

}  // namespace evert
