#pragma once
#include "evert/integrators/system.hpp"

#include <cstdint>

namespace evert {

/// Notices energy that comes from nowhere, in scenes in which nothing does work on the bodies but gravity:
/// once in a while, since the energy costs about as much as half of the forces.
///
/// An error of the scheme makes energies ripple by a share of themselves (of symplectic Euler, by 2/(1 + s)
/// at a share s of the bound). A hundred times that of the start, and most of it gained, is none.
class EnergyWatch {
 public:
  static constexpr std::int64_t interval = 64;  ///< [steps]
  static constexpr double limit = 100;          ///< of the energy of the start and the work of gravity

  /// Not collective. `closed`: no obstacle, held node, load, event, activation or goal does work.
  explicit EnergyWatch(bool closed = false) : closed_(closed) {}

  /// Collective. After every step of `dt` [s], of sound states. True when the energy has grown beyond
  /// `limit`.
  [[nodiscard]] bool has_grown(const System& system, double dt);
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
  };
  [[nodiscard]] static Energies energies_of(const System& system);

  bool closed_;
  std::int64_t looks_ = 0;
  Energies first_;
  double growth_ = 1;
};

}  // namespace evert
