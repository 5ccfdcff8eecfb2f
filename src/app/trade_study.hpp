#pragma once
#include "evert/trade/comparison.hpp"
#include "evert/trade/front.hpp"

#include "trade_runs.hpp"
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace evert {

/// A scene, the settings that vary, and the reference that they are compared with: what `evert trade` and
/// `evert tune` share. All calls are collective unless said otherwise.
class TradeStudy {
 public:
  /// Reads the scene, finds out what the settings mean, and looks at the mesh of the reference. Throws
  /// UserError.
  TradeStudy(MPI_Comm comm, const TradeArguments& arguments, std::ostream& out);

  /// Makes the three runs of the reference. False: a signal came. Throws SimulationError where one of them
  /// does not finish.
  [[nodiscard]] bool make_reference();
  /// A setting, timed `repetitions` times at least, with its errors, which all ranks know. Empty: a signal
  /// came.
  [[nodiscard]] std::optional<trade::Trial> run(const trade::Choice& choice, int repetitions);

  // Not collective:
  [[nodiscard]] const SceneSource& source() const { return source_; }
  [[nodiscard]] const std::vector<trade::Axis>& axes() const { return axes_; }
  [[nodiscard]] const std::vector<trade::Choice>& grid() const { return grid_; }
  [[nodiscard]] const trade::ReferenceQuality& quality() const { return quality_; }
  [[nodiscard]] const std::string& directory() const { return directory_; }
  [[nodiscard]] std::string name() const { return name_; }
  [[nodiscard]] int runs_made() const { return runs_->made(); }
  [[nodiscard]] std::string path(const std::string& file) const;
  /// The setting as one can paste it into a shell.
  [[nodiscard]] std::string command_of(const trade::Choice& choice) const;
  /// Text for the user, on rank 0; `detail` is what -quiet leaves out.
  void say(const std::string& text) const;
  void say_detail(const std::string& text) const;

 private:
  [[nodiscard]] std::vector<trade::Axis> find_axes(Simulation& simulation, const SceneConfig& scene);
  void describe_reference() const;

  MPI_Comm comm_;
  const TradeArguments& arguments_;
  std::ostream& out_;
  SceneSource source_;
  std::string name_, directory_;
  trade::Automatic automatic_;
  std::vector<trade::Axis> axes_;
  std::vector<trade::Choice> grid_;
  double ratio_ = 2;
  std::optional<TradeRuns> runs_;
  trade::ReferenceQuality quality_;
  trade::Measurement reference_;  // on rank 0
};

/// What a command returns when a signal came, after it said how to go on.
[[nodiscard]] int interrupted_trade(MPI_Comm comm, const TradeStudy& study);

}  // namespace evert
