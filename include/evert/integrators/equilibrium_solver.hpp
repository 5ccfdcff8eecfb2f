#pragma once
#include "evert/integrators/method.hpp"
#include "evert/integrators/stiffness_matrix.hpp"
#include "evert/integrators/system.hpp"

#include <petscsnes.h>

#include <span>
#include <string>

namespace evert {

using SnesHandle = PetscHandle<SNES, SNESDestroy>;

/// Finds positions of rest, P (f(x) − rest load) = 0, by PETSc's SNES with option prefix `quasistatic_`: f
/// elastic forces and loads, P the projector off the held components.
///
/// `-quasistatic_mat_type aij|baij|sbaij`, all of PETSc's `-quasistatic_snes_*`, `-quasistatic_ksp_*` and
/// `-quasistatic_pc_*`. docs/design/quasistatic.md
class EquilibriumSolver {
 public:
  /// Collective. Reads the options; throws UserError for one that cannot work.
  EquilibriumSolver(const System& system, TangentChoice choice);
  EquilibriumSolver(const EquilibriumSolver&) = delete;
  EquilibriumSolver& operator=(const EquilibriumSolver&) = delete;

  /// Collective. With -help: makes PETSc print what the solver can be told.
  static void print_options(MPI_Comm comm);

  struct Outcome {
    bool converged = false;
    std::string reason;         ///< PETSc's word for it
    int newton_iterations = 0;  ///< SNES
    int linear_iterations = 0;  ///< KSP
  };
  /// Collective. From a state `x` of (nearly) rest, takes held components by the ways [m] that `held`
  /// prescribes and finds x with P (f(x) − withheld) = 0, loads being those of time `t` [s]. `x` is then a
  /// state of rest when converged, and where it was otherwise. `-quasistatic_snes_rtol` counts from the first
  /// residual or from `load` [N], the norm of what all parts of a step apply, whichever is larger.
  Outcome solve(NodeField& x, std::span<const NodeConstraint> held, const NodeField& withheld, double load,
                double t);

 private:
  friend struct EquilibriumCallbacks;
  void residual(Vec x, Vec out);
  double energy_change(Vec x);
  void jacobian(Vec x);
  void begin_iteration();

  void set_trial(Vec x);
  double predict();
  [[nodiscard]] double inertia(Vec residual) const;
  [[nodiscard]] TangentForm next_form();
  SNESConvergedReason iterate(double target, Outcome& outcome);

  const System& system_;
  TangentChoice choice_;
  double total_mass_ = 0;  // [kg] of all ranks
  double mass_norm_ = 0;   // [kg] root of the sum of squares
  double length_ = 0;      // [m] radius of gyration at rest
  StiffnessMatrix stiffness_;
  SnesHandle snes_;
  double atol_ = 0, rtol_ = 0;
  PetscInt most_iterations_ = 0;

  // Of the solve that goes on:
  std::span<const NodeConstraint> held_;
  NodeField trial_, force_, load_;  // load_: loads less what is withheld
  NodeField pull_;                  // of the ways of held nodes on the others
  VecHandle x_, function_, base_, base_residual_, work_, slope_, right_, change_;
  double base_energy_ = 0;
  double least_inertia_ = 0;  // σ [1/s²] that keeps rigid motions of free bodies within rounding
  double full_below_ = 0;     // the full tangent is for residuals below [N]
  double last_norm_ = 0;      // residual of the iteration before [N]
  bool full_used_ = false;
};

}  // namespace evert
