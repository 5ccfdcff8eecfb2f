#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The scenes of `evert extremes`: small, and as bad as they can be.
namespace evert {

/// What a case must end in.
enum class Promise {
  recovery,   ///< recovered
  stability,  ///< recovered or stable
  detection,  ///< stopped as unstable, with a step that works
  any,        ///< one of the grades: where the edge is, is what one wants to know
};

struct ExtremeCase {
  std::string family;   ///< its table in docs/extremes.md
  std::string row;      ///< of that table
  std::string column;   ///< of that table
  std::string scene{};  ///< YAML
  Promise promise = Promise::any;
  std::int64_t most_steps = 1000000;  ///< the run ends there, or at the scene's end_time
  bool ends_recovered = true;         ///< a run that is to recover ends as soon as it has
  double energy_gain = 0.81;  ///< that is stable, over the energy: what steps at 0.9 of the limit ripple
  std::optional<double> step_over_limit{};  ///< integrator.time_step, in true limits of the step at rest
  std::vector<std::pair<std::string, std::string>> files{};  ///< meshes beside the scene: name, content

  /// "family/row/column", without blanks.
  [[nodiscard]] std::string name() const;
};

/// All cases; `ranks` is how many elements the cases with one element a rank have.
[[nodiscard]] std::vector<ExtremeCase> extreme_cases(int ranks);

}  // namespace evert
