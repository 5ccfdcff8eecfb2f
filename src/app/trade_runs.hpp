#pragma once
#include "evert/app/trade_command.hpp"
#include "evert/scene/source.hpp"
#include "evert/trade/run_store.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <string>

namespace evert {

/// What a simulation of `scene` would be, without running it. Collective. The PETSc options of the scene are
/// in force while `look` runs, and no longer.
void look_at_scene(MPI_Comm comm, const SceneConfig& scene, bool allow_unknown_options,
                   const std::function<void(BuiltScene&)>& look);

/// Makes the runs of a sweep, or finds them in its store.
class TradeRuns {
 public:
  TradeRuns(MPI_Comm comm, const SceneSource& source, trade::SamplePlan plan, const std::string& directory,
            bool allow_unknown_options);

  /// Collective. The run with these overrides, timed `repetitions` times at least; empty: a signal came. Full
  /// on rank 0, elsewhere without what was measured.
  [[nodiscard]] std::optional<trade::RunRecord> run(const trade::Overrides& overrides, int repetitions);

  /// Processor seconds of one rank that a run may take from now on.
  void limit(double seconds) { limit_ = seconds; }
  [[nodiscard]] double limit() const { return limit_; }
  [[nodiscard]] const trade::SamplePlan& plan() const { return plan_; }
  /// How many simulations were made.
  [[nodiscard]] int made() const { return made_; }

 private:
  [[nodiscard]] std::optional<trade::RunRecord> simulate(const trade::Overrides& overrides);
  [[nodiscard]] std::optional<trade::RunRecord> run_built(BuiltScene& built, double heap_before);
  [[nodiscard]] std::optional<trade::RunRecord> found(const std::string& identity) const;
  [[nodiscard]] std::string identity_of(const trade::Overrides& overrides) const;

  MPI_Comm comm_;
  const SceneSource& source_;
  trade::SamplePlan plan_;
  trade::RunStore store_;
  bool allow_unknown_options_;
  std::string plan_text_;
  double limit_ = std::numeric_limits<double>::infinity();
  int made_ = 0;
};

}  // namespace evert
