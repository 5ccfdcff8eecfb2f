#pragma once
#include "evert/app/extreme_case.hpp"

#include <mpi.h>

#include <optional>
#include <string>

/// One extreme case, run and graded.
namespace evert {

enum class Grade {
  recovered,  ///< at the rest shape, nothing inverted
  stable,     ///< came to its end with its energy bounded
  failed,     ///< stopped with a message that says what, when and what to try
  defect,     ///< anything else
};
[[nodiscard]] const char* name_of(Grade grade);

struct Trial {
  Grade grade = Grade::defect;
  bool kept = false;         ///< the promise of the case
  std::string note{};        ///< the message of what failed, or what is wrong with a defect
  std::int64_t steps = 0;    ///< made
  double seconds = 0;        ///< [s] of wall time
  bool let_through = false;  ///< something that is not finite was left for the output

  // Of a case with a step over the limit:
  double time_step = 0;               ///< [s]
  std::optional<double> suggested{};  ///< [s] that the message recommends
  bool suggestion_works = false;      ///< with it the same case is stable
};

/// What a run ended with, from which the grade follows.
struct TrialEnd {
  std::string error{};  ///< of a UserError or a SimulationError; empty: none
  bool timed_out = false;
  bool finite = true;
  long long inverted_points = 0;
  double shape_error = 0;     ///< RMS distance to the rest shape over the size
  double stable_gain = 0.81;  ///< ExtremeCase::energy_gain
  double energy_gain = 0;  ///< most that it ever had more than at the start, over the scale of its energies
};

inline constexpr double recovered_within = 1e-6;  ///< shape error over the size, docs/recovery.md

/// The grade, and what is wrong with a defect.
struct Verdict {
  Grade grade = Grade::defect;
  std::string note{};
};
[[nodiscard]] Verdict graded(const TrialEnd& end);

/// The integrator.time_step that a message recommends [s].
[[nodiscard]] std::optional<double> suggested_step(const std::string& message);

/// Collective. Builds and runs the case, its files in `directory`, which must exist; after `time_limit` [s]
/// of wall time it is a defect. A detected instability is run again with the step that the message
/// recommends.
[[nodiscard]] Trial try_case(MPI_Comm comm, const ExtremeCase& extreme, const std::string& directory,
                             double time_limit);

/// Collective. Writes scene.yaml, for `evert run`, and its meshes; returns the path of the scene. The scene
/// has the time step in it.
std::string write_case(MPI_Comm comm, const ExtremeCase& extreme, const std::string& directory);

}  // namespace evert
