#include "evert/core/log.hpp"

#include "evert/core/petsc.hpp"

namespace evert {
namespace {

constexpr std::array<std::string_view, phase_count> phase_names{
    "setup",        "force",   "stretch_svd", "damping_apply", "damping_solve", "assembly",
    "static_solve", "contact", "filter",      "vector_update", "halo",          "io"};

constexpr auto no_phase = static_cast<Phase>(phase_count);

// PETSc's log is global to the process; so is ours.
struct Log {
  std::array<PetscLogEvent, phase_count> events{};
  std::array<PetscLogStage, 2> stages{};
  std::array<double, phase_count> seconds{};
  std::array<std::int64_t, phase_count> calls{};
  Phase now = no_phase;  // the innermost phase
  double since = 0;      // wall time up to which it is booked [s]
  bool registered = false;
};
Log& log() {
  static Log instance;
  return instance;
}

std::size_t index(Phase phase) { return static_cast<std::size_t>(phase); }

/// Books the time until now to the phase that went on, and lets `next` go on. Returns the former.
Phase change_to(Phase next) {
  const double time = MPI_Wtime();
  const auto before = log().now;
  if (before != no_phase) log().seconds[index(before)] += time - log().since;
  log().since = time;
  log().now = next;
  return before;
}

}  // namespace

std::string_view name_of(Phase phase) { return phase_names[index(phase)]; }

void register_log_events() {
  if (log().registered) return;
  PetscClassId classid = 0;
  check(PetscClassIdRegister("Evert", &classid));
  for (std::size_t i = 0; i < phase_count; ++i) {
    const std::string name = "Evert_" + std::string(phase_names[i]);
    check(PetscLogEventRegister(name.c_str(), classid, &log().events[i]));
  }
  check(PetscLogStageRegister("Evert set-up", &log().stages[0]));
  check(PetscLogStageRegister("Evert time steps", &log().stages[1]));
  log().registered = true;
}

StageScope::StageScope(Stage stage) {
  register_log_events();
  check(PetscLogStagePush(log().stages[static_cast<std::size_t>(stage)]));
}

StageScope::~StageScope() { static_cast<void>(PetscLogStagePop()); }

PhaseScope::PhaseScope(Phase phase, double flops) : phase_(phase), outer_(change_to(phase)) {
  ++log().calls[index(phase)];
  if (!log().registered) return;
  PetscLogEventBegin(log().events[index(phase)], 0, 0, 0, 0);
  static_cast<void>(PetscLogFlops(flops));
}

PhaseScope::~PhaseScope() {
  if (log().registered) PetscLogEventEnd(log().events[index(phase_)], 0, 0, 0, 0);
  change_to(outer_);
}

const std::array<double, phase_count>& phase_seconds() { return log().seconds; }
const std::array<std::int64_t, phase_count>& phase_calls() { return log().calls; }

}  // namespace evert
