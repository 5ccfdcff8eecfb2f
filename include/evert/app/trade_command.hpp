#pragma once
#include "evert/app/command_line.hpp"
#include "evert/trade/sampler.hpp"
#include "evert/trade/tuning.hpp"

#include <mpi.h>

#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

namespace evert {

/// The arguments of `evert trade` and `evert tune`: those of a run, and how settings vary.
struct TradeArguments {
  RunArguments run;
  std::vector<trade::Variation> variations;  ///< of each -vary; none: a default set
  trade::Overrides reference;                ///< of each -reference
  std::vector<std::string> probes;           ///< of each -probe
  std::string out;                           ///< -out directory, or empty: by the scene's name
  std::optional<int> repeat;                 ///< -repeat
  std::optional<double> limit;               ///< -limit [s] of processor time of one rank for a run
  trade::SampleOptions samples;              ///< -samples
  trade::TuningGoal goal;                    ///< -error or -budget, of tune
  bool help = false;
};

/// `command` is "trade" or "tune". Throws UserError as parse_run_arguments does, for what only a run can do,
/// and for a misspelt option.
[[nodiscard]] TradeArguments parse_trade_arguments(std::span<const std::string> arguments,
                                                   const std::string& command);

/// Collective. `evert trade SCENE.yaml`: runs all settings, measures errors and costs, and writes a table, a
/// plot and a scene for each point of the Pareto front. Returns the exit code, 130 when interrupted; throws
/// UserError, and SimulationError where the reference fails.
int trade_command(MPI_Comm comm, const TradeArguments& arguments, std::ostream& out);

/// Collective. `evert tune SCENE.yaml`: finds the cheapest setting within an error or the most accurate one
/// within a budget, with few runs. As trade_command; SimulationError also where no setting does.
int tune_command(MPI_Comm comm, const TradeArguments& arguments, std::ostream& out);

/// What `evert trade -help` and `evert tune -help` print.
[[nodiscard]] std::string trade_usage();
[[nodiscard]] std::string tune_usage();

}  // namespace evert
