#include "evert/app/extreme_trial.hpp"

#include "evert/app/run_loop.hpp"
#include "evert/core/collective.hpp"
#include "evert/core/formatted.hpp"
#include "evert/filter/spectrum.hpp"
#include "evert/io/files.hpp"
#include "evert/math/nodal.hpp"
#include "evert/scene/build.hpp"
#include "evert/scene/load.hpp"
#include "evert/sim/shape_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

namespace evert {
namespace {

/// Follows a run: energies, whether all that could be written is finite, and when to end.
class TrialObserver final : public Observer {
 public:
  TrialObserver(const ExtremeCase& extreme, const BodyRange& body, double deadline)
      : extreme_(extreme), deadline_(deadline) {
    const auto size = body.upper - body.lower;
    size_ = std::max({size[0], size[1], size[2]});
    end.stable_gain = extreme.energy_gain;
  }

  void observe(Simulation& simulation, const StepReport& /*report*/) override {
    const auto steps = simulation.steps();
    if (steps <= every_step || steps % some == 0) look(simulation);
    if (steps >= extreme_.most_steps) simulation.request_stop();
    if (steps % some == 0 && MPI_Wtime() > deadline_) {
      end.timed_out = true;
      simulation.request_stop();
    }
    if (extreme_.promise == Promise::recovery && extreme_.ends_recovered && steps % recovery_looks == 0) {
      measure_shape(simulation);
      if (graded(end).grade == Grade::recovered) simulation.request_stop();
    }
  }

  void finish(Simulation& simulation) override {
    look(simulation);
    measure_shape(simulation);
    int late = end.timed_out ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &late, 1, MPI_INT, MPI_MAX, simulation.mesh().comm);
    end.timed_out = late != 0;
  }

  TrialEnd end;

 private:
  static constexpr std::int64_t every_step = 100, some = 16, recovery_looks = 64;

  void look(const Simulation& simulation) {
    const auto now = simulation.measure();
    if (!std::isfinite(now.total_energy()) || !finite(simulation)) end.finite = false;
    if (simulation.steps() == 0) first_ = now.total_energy();
    scale_ = std::max({scale_, now.kinetic_energy + now.elastic_energy, std::abs(first_)});
    if (scale_ > 0) end.energy_gain = std::max(end.energy_gain, (now.total_energy() - first_) / scale_);
  }

  [[nodiscard]] static bool finite(const Simulation& simulation) {
    const auto is_finite = [](double value) { return std::isfinite(value); };
    int all = std::ranges::all_of(simulation.positions().owned(), is_finite) &&
                      std::ranges::all_of(simulation.velocities().owned(), is_finite)
                  ? 1
                  : 0;
    MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, simulation.mesh().comm);
    return all != 0;
  }

  void measure_shape(const Simulation& simulation) {
    end.inverted_points = simulation.inverted_points();
    end.shape_error =
        rms_shape_error(simulation.mesh(), simulation.positions(), 0, simulation.mesh().total_nodes) / size_;
  }

  const ExtremeCase& extreme_;
  double deadline_, size_ = 1, first_ = 0, scale_ = 0;
};

/// The true limit of the step at rest [s].
double limit_at_rest(const Simulation& simulation) {
  const auto& mesh = simulation.mesh();
  NodeField x(mesh);
  for (LocalIndex i = 0; i < mesh.owned_nodes; ++i)
    set_node_value(x.owned(), i, mesh.rest_positions[static_cast<std::size_t>(i)]);
  x.touched();
  MassScaledStiffness stiffness(mesh, simulation.elastic());
  stiffness.assemble(x);
  return 2 / std::sqrt(fastest_mode(stiffness).squared_frequency);
}

SceneConfig scene_with_step(const std::string& text, const std::string& path, double time_step) {
  std::vector<std::string> overrides;
  if (time_step > 0) overrides.push_back(formatted("integrator.time_step=%.17g", time_step));
  return parse_scene(text, path, overrides);
}

/// The step that the case asks for, 0 where the scene says it.
double time_step_of(MPI_Comm comm, const ExtremeCase& extreme, const std::string& path) {
  if (!extreme.step_over_limit) return 0;
  const auto built = build_scene(comm, scene_with_step(extreme.scene, path, 0));
  return *extreme.step_over_limit * limit_at_rest(*built.simulation);
}

std::string write_files(MPI_Comm comm, const ExtremeCase& extreme, const std::string& directory) {
  const auto in = [&](const std::string& name) { return (std::filesystem::path(directory) / name).string(); };
  on_root(comm, [&] {
    for (const auto& [name, content] : extreme.files) write_file(in(name), content);
  });
  return in("scene.yaml");
}

/// Runs to the end, whatever that is.
Trial run_with_step(MPI_Comm comm, const ExtremeCase& extreme, const std::string& path, double time_step,
                    double deadline) {
  Trial trial{.time_step = time_step};
  TrialEnd end;
  try {
    const auto scene = scene_with_step(extreme.scene, path, time_step);
    const auto built = build_scene(comm, scene);
    std::vector<std::unique_ptr<Observer>> observers;
    observers.push_back(std::make_unique<TrialObserver>(extreme, built.bodies.front(), deadline));
    auto& observer = static_cast<TrialObserver&>(*observers.front());
    try {
      run_loop(*built.simulation, scene.end_time, observers);
      end = observer.end;
    } catch (const SimulationError& error) {
      end.error = error.what();
      end.finite = observer.end.finite;
    }
    trial.steps = built.simulation->steps();
  } catch (const UserError& error) {
    end.error = error.what();
  } catch (const SimulationError& error) {  // of the state of the start
    end.error = error.what();
  }
  const auto verdict = graded(end);
  trial.grade = verdict.grade;
  trial.note = verdict.note;
  trial.let_through = !end.finite;
  return trial;
}

bool keeps(Promise promise, const Trial& trial) {
  switch (promise) {
    case Promise::recovery:
      return trial.grade == Grade::recovered;
    case Promise::stability:
      return trial.grade == Grade::recovered || trial.grade == Grade::stable;
    case Promise::detection:
      return trial.grade == Grade::failed && trial.suggestion_works;
    case Promise::any:
      break;
  }
  return trial.grade != Grade::defect;
}

}  // namespace

std::string write_case(MPI_Comm comm, const ExtremeCase& extreme, const std::string& directory) {
  const auto path = write_files(comm, extreme, directory);
  const auto scene = scene_with_step(extreme.scene, path, time_step_of(comm, extreme, path));
  on_root(comm, [&] { write_file(path, scene.text); });
  return path;
}

Trial try_case(MPI_Comm comm, const ExtremeCase& extreme, const std::string& directory, double time_limit) {
  const double begin = MPI_Wtime();
  const auto path = write_files(comm, extreme, directory);
  auto trial = run_with_step(comm, extreme, path, time_step_of(comm, extreme, path), begin + time_limit);
  if (trial.grade == Grade::failed && extreme.step_over_limit) {
    trial.suggested = suggested_step(trial.note);
    if (trial.suggested) {
      const auto again = run_with_step(comm, extreme, path, *trial.suggested, begin + time_limit);
      trial.suggestion_works = again.grade == Grade::stable || again.grade == Grade::recovered;
      if (!trial.suggestion_works) trial.note += "; with that step: " + again.note;
    }
  }
  trial.kept = keeps(extreme.promise, trial);
  trial.seconds = MPI_Wtime() - begin;
  return trial;
}

}  // namespace evert
