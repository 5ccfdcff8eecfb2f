#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace evert {

/// Notices motion that turns round in every step and grows: what a step above the stable bound makes of the
/// fastest vibration, and nothing else does.
///
/// Past the bound, ωΔt > 2, a vibration is multiplied in every step by −A, A = (ωΔt)²/2 − 1 + √(((ωΔt)²/2 −
/// 1)² − 1) > 1. Below it, at ωΔt = 2 cos(δ/2), velocities that turn round in every step grow along sin(nδ)
/// at most, whatever the energy of the start: by less than 1/sin²δ in the square after the first turn. A
/// growth of `limit` is then possible within 1.3e-3 of the bound only; at 0.9 of it, 1/sin²δ is 1.6. Loads
/// and moving obstacles do not turn velocities round again and again, and an impact does so once: the largest
/// growth in one step does not count.  docs/design/time-stepping.md
class GrowthWatch {
 public:
  static constexpr double limit = 100;  ///< of Σ m v², in steps in a row that all turn it round
  static constexpr double much = 10;    ///< no longer a state to go on from, whatever the reason

  struct Sums {
    double turned = 0;  ///< Σ m v·v' over owned nodes, v' of the look before [J]
    double square = 0;  ///< Σ m v² [J]
  };

  explicit GrowthWatch(std::size_t owned_nodes) : before_(3 * owned_nodes) {}

  /// Not collective. After every step: this rank's part; remembers `velocities`, 3 per owned node [m/s].
  [[nodiscard]] Sums look(std::span<const double> masses, std::span<const double> velocities);
  /// Not collective. With the sums over all ranks.
  void judge(const Sums& all);
  /// What was seen belongs to another state.
  void forget() { square_ = 0, turns_ = 0, growth_ = 1, largest_ = 1, all_growth_ = 1; }

  /// Of Σ m v², since the first of the turns that go on, but for the step that it grew most in.
  [[nodiscard]] double growth() const { return growth_ / largest_; }
  [[nodiscard]] int turns() const { return turns_; }
  [[nodiscard]] bool exploding() const { return growth() > limit; }
  [[nodiscard]] bool suspicious() const { return all_growth_ > much; }

 private:
  std::vector<float> before_;  // of velocities: only signs and powers of ten matter
  double square_ = 0;          // of the look before
  int turns_ = 0;              // in a row, each with growth
  double growth_ = 1, largest_ = 1;
  double all_growth_ = 1;  // with the first turn and the largest step
};

}  // namespace evert
