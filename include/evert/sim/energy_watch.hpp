#pragma once
#include "evert/integrators/system.hpp"

#include <cstdint>

namespace evert {

/// Notices energy that comes from nowhere, where nothing does work on the bodies but gravity:
/// once in a while, since the energy costs about as much as half of the forces.
///
/// An error of the scheme makes energies ripple by a share of themselves (of symplectic Euler, by 2/(1 + s)
/// at a share s of the bound). A hundred times that of the start, and most of it gained, is none.
class EnergyWatch {
 public:
  static constexpr std::int64_t interval = 64;  ///< [steps]
  static constexpr double limit = 100;          ///< of the energy of the start and the work of gravity

  /// Not collective. `closed`: no held node, load, event, activation or goal does work. What obstacles that
  /// move touch begins anew.
  explicit EnergyWatch(bool closed = false) : closed_(closed) {}

  /// Collective. After every step of `dt` [s], of sound states. True when the energy has grown beyond
  /// `limit`.
  [[nodiscard]] bool has_grown(const System& system, double dt);
  /// Collective. True where it has grown by a tenth of that by now.
  [[nodiscard]] bool is_growing(const System& system);
  /// The next look is at a start.
  void forget() { looks_ = 0; }
  /// Times that the energy was that of the start, at the last look.
  [[nodiscard]] double growth() const { return growth_; }

 private:
  struct Energies {
    double moving = 0;     // kinetic and elastic [J]
    double potential = 0;  // of gravity [J]
    double square = 0;     // Σ m v² [J]
    double reach = 0;      // Σ m x² [kg m²]
    bool touched = false;  // by obstacles that move, since the last look
  };
  struct Obstacles {
    double impulses = 0;  // a number that changes with what they give on this rank
    double poses = 0;     // and with where they are
    bool moves = false;   // some of them, now
  };
  [[nodiscard]] static Obstacles obstacles_of(const System& system);
  [[nodiscard]] Energies energies_of(const System& system);
  [[nodiscard]] bool grows_beyond(double factor, const Energies& now);

  bool closed_;
  std::int64_t looks_ = 0;
  Energies first_;
  Obstacles obstacles_;
  double growth_ = 1;
};

}  // namespace evert
