#pragma once
#include "evert/integrators/system.hpp"

namespace evert {

/// `time_step: auto`: as large as stability and accuracy allow.  PHYSICS 5
struct TimeStepOptions {
  double safety = 0.9;  ///< share of the stable step, in (0, 1]
  double max_strain_increment =
      0.1;  ///< largest change of any element's strain in one step, of its stretch above 1
};

/// The stable_step of an integrator: what of the elements' bounds limits it.
using StabilityLimit = double (*)(const System&);

/// Chooses the step from the element bounds at the current tangent. They are re-estimated every few steps,
/// and at once where the state has changed quickly; in between, the step may only shrink by the strain limit.
class TimeStepControl {
 public:
  explicit TimeStepControl(const TimeStepOptions& options) : options_(options) {}

  /// Collective. The step to make now [s]; infinity when neither stiffness nor motion limits it, and next to
  /// nothing where the stresses of the state overflow.
  [[nodiscard]] double suggest(System& system, StabilityLimit limit);

  /// The last suggestion rests on an estimate of its own.
  [[nodiscard]] bool is_fresh() const { return age_ == 1; }
  /// Forget the last estimate (a material has changed).
  void reset() { age_ = never; }
  /// How long the last estimate may be used at most [s].
  [[nodiscard]] double horizon() const { return steps_between_estimates * stable_; }

  // What a checkpoint keeps, so that a restart chooses the same steps.
  struct State {
    double stable = 0;
    double age = 0;
  };
  [[nodiscard]] State state() const { return {stable_, static_cast<double>(age_)}; }
  void restore(const State& state);

 private:
  // The bound moves with the strain, and strain by at most max_strain_increment in a step: a few steps old,
  // it is still within what `safety` covers.
  static constexpr int steps_between_estimates = 4;
  static constexpr int never = -1;
  TimeStepOptions options_;
  double stable_ = 0;  // [s] last estimate over all ranks
  int age_ = never;    // steps since then
};

}  // namespace evert
