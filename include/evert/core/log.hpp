#pragma once
#include <petsclog.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

/// Where the time goes: one set of phases, shown by PETSc's -log_view and, without any option, in
/// summary.json. A phase inside another takes its time away from it, so that the seconds of all phases add up
/// to no more than the wall time; -log_view counts it to both, as PETSc always does.
namespace evert {

enum class Phase : std::size_t {
  setup,          ///< meshes, partition, element data
  force,          ///< elastic forces: deformation gradients, their SVD, stresses, scatter
  stretch_svd,    ///< singular values for reports: minimum stretches, stable step
  damping_apply,  ///< products with the damping operator
  damping_solve,  ///< the conjugate gradients around them
  assembly,       ///< stiffness matrices of the quasistatic solves
  static_solve,   ///< the quasistatic solves around forces and assembly
  contact,        ///< obstacles and friction
  filter,         ///< selection of filtered elements, their implicit part or their projection
  vector_update,  ///< nodal updates of positions and velocities
  halo,           ///< sending ghost values, and waiting for them
  io,             ///< frames, logs and checkpoints
};
inline constexpr std::size_t phase_count = 12;
[[nodiscard]] std::string_view name_of(Phase phase);

/// Registers the phases as PETSc events, and "Evert set-up" and "Evert time steps" as stages. Call once after
/// PetscInitialize.
void register_log_events();

enum class Stage { setup, time_steps };
/// Names the stage that -log_view books what follows under, until the object dies.
class StageScope {
 public:
  explicit StageScope(Stage stage);
  ~StageScope();
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;
};

/// Books the wall time of its life, and `flops`, to a phase. Scopes must nest.
class PhaseScope {
 public:
  explicit PhaseScope(Phase phase, double flops = 0);
  ~PhaseScope();
  PhaseScope(const PhaseScope&) = delete;
  PhaseScope& operator=(const PhaseScope&) = delete;

 private:
  Phase phase_;
  Phase outer_;  // what went on before and goes on afterwards
};

/// Wall seconds of this rank booked to each phase so far, phases inside it left out.
[[nodiscard]] const std::array<double, phase_count>& phase_seconds();
/// How often each phase began so far.
[[nodiscard]] const std::array<std::int64_t, phase_count>& phase_calls();

}  // namespace evert
