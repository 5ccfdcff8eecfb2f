#include "evert/app/run_command.hpp"

#include "evert/app/run_loop.hpp"
#include "evert/app/run_observers.hpp"
#include "evert/core/collective.hpp"
#include "evert/core/formatted.hpp"
#include "evert/core/petsc.hpp"
#include "evert/forces/kernels/cpu_level.hpp"
#include "evert/io/files.hpp"
#include "evert/io/summary.hpp"
#include "evert/scene/build.hpp"
#include "evert/scene/load.hpp"
#include "evert/scene/petsc_options.hpp"
#include "evert/sim/shape_error.hpp"

#include "filter_report.hpp"
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <numeric>
#include <utility>
#include <vector>

namespace evert {
namespace {

constexpr int done = 0;
constexpr int interrupted = 130;

/// Where a run's files are, by name.
struct RunFiles {
  std::string directory;
  [[nodiscard]] std::string operator()(const char* name) const {
    return (std::filesystem::path(directory) / name).string();
  }
};

/// The observers of a run; those that others ask have names.
struct Observers {
  std::vector<std::unique_ptr<Observer>> all;
  RunStatistics* statistics = nullptr;
  FrameObserver* frames = nullptr;            // where the scene wants frames
  CheckpointObserver* checkpoints = nullptr;  // always: a signal writes one

  template <class T>
  T* add(std::unique_ptr<T> observer) {
    auto* pointer = observer.get();
    all.push_back(std::move(observer));
    return pointer;
  }
};

FrameFields fields_of(const OutputConfig& output) {
  FrameFields fields{false, false, false, false, false, false};
  for (const auto field : output.fields) {
    if (field == OutputField::velocity) fields.velocity = true;
    if (field == OutputField::min_stretch) fields.min_stretch = true;
    if (field == OutputField::inversion) fields.inversion = true;
    if (field == OutputField::rank) fields.rank = true;
    if (field == OutputField::plastic_strain) fields.plastic_strain = true;
    if (field == OutputField::plastic_volume) fields.plastic_volume = true;
  }
  return fields;
}

/// How often inverted points are counted: with the frames, or a hundred times.
double look_interval(const SceneConfig& scene) {
  return scene.output.frames_per_second ? 1 / *scene.output.frames_per_second : scene.end_time / 100;
}

Observers make_observers(const SceneConfig& scene, const Simulation& simulation, const RunFiles& files,
                         const RunArguments& arguments) {
  Observers observers;
  const auto& mesh = simulation.mesh();
  const bool restarted = !arguments.restart.empty();
  observers.statistics = observers.add(std::make_unique<RunStatistics>(look_interval(scene)));
  if (scene.output.frames_per_second) {
    const auto fields = fields_of(scene.output);
    auto writer = restarted ? FrameWriter::continue_from(mesh, files("run.h5"), fields, simulation.time(),
                                                         simulation.obstacles())
                            : FrameWriter(mesh, files("run.h5"), fields, simulation.obstacles());
    observers.frames = observers.add(
        std::make_unique<FrameObserver>(std::move(writer), 1 / *scene.output.frames_per_second));
  }
  if (scene.output.energy_log) {
    const bool flows = simulation.elastic().may_flow();
    auto log = restarted ? EnergyLog::continue_from(mesh.comm, files("energy.csv"), simulation.time(), flows)
                         : EnergyLog(mesh.comm, files("energy.csv"), flows);
    observers.add(std::make_unique<EnergyObserver>(std::move(log), *scene.output.energy_log));
    if (!simulation.obstacles().empty()) {
      const auto obstacles = simulation.obstacles();
      auto rows = restarted ? ObstacleLog::continue_from(mesh.comm, files("obstacles.csv"), obstacles,
                                                         simulation.time())
                            : ObstacleLog(mesh.comm, files("obstacles.csv"), obstacles);
      observers.add(std::make_unique<ObstacleObserver>(std::move(rows), *scene.output.energy_log));
    }
  }
  observers.checkpoints = observers.add(
      std::make_unique<CheckpointObserver>(CheckpointWriter(mesh, files("checkpoint.h5"), scene.identity),
                                           scene.checkpoint.value_or(CheckpointConfig{})));
  observers.add(
      std::make_unique<ProgressObserver>(simulation, scene.end_time, arguments.quiet, *observers.statistics));
  return observers;
}

void restore(Simulation& simulation, const std::string& path, const std::string& fingerprint) {
  const auto state = read_checkpoint(simulation.mesh(), path, fingerprint);
  simulation.restore(state.nodes(), state.scalars, state.flow);
}

GlobalIndex quadrature_points_of(const DistributedMesh& mesh) {
  GlobalIndex points = 0;
  for (const auto& cells : mesh.cells) points += GlobalIndex{quadrature_points(cells.type)} * cells.size();
  MPI_Allreduce(MPI_IN_PLACE, &points, 1, MPI_INT64_T, MPI_SUM, mesh.comm);
  return points;
}

RunSummary summarize(const SceneConfig& scene, const BuiltScene& built, const Observers& observers,
                     RunEnd end) {
  const auto& simulation = *built.simulation;
  RunSummary summary;
  summary.scene = scene.name;
  summary.outcome = end == RunEnd::reached_end_time ? "finished" : "interrupted";
  summary.nodes = simulation.mesh().total_nodes;
  summary.cells = simulation.mesh().total_cells;
  summary.steps = simulation.steps();
  summary.simulated_time = simulation.time();
  summary.cg_iterations = observers.statistics->cg_iterations;
  summary.newton_iterations = observers.statistics->newton_iterations;
  summary.linear_iterations = observers.statistics->linear_iterations;
  summary.frames = observers.frames == nullptr ? 0 : observers.frames->frames();
  summary.max_inverted_points = observers.statistics->max_inverted;
  summary.max_inverted_time = observers.statistics->max_inverted_time;
  summary.quadrature_points = quadrature_points_of(simulation.mesh());
  summary.final_state = simulation.measure();
  const auto impulses = simulation.obstacle_impulses();
  for (std::size_t o = 0; o < impulses.size(); ++o)
    summary.obstacles.emplace_back(simulation.obstacles()[o]->name(), impulses[o]);
  summary.phases = phase_times(simulation.mesh().comm);
  summary.cpu_level = kernels::chosen_cpu_level().name;
  for (const auto& body : built.bodies)
    summary.shape_errors.emplace_back(body.name, rms_shape_error(simulation.mesh(), simulation.positions(),
                                                                 body.first_node, body.end_node));
  return summary;
}

std::string inversion_text(const RunSummary& summary) {
  if (summary.max_inverted_points == 0) return "no element at any time";
  const auto left = summary.final_state.inverted_points;
  std::array<char, 96> most{};
  std::snprintf(most.data(), most.size(), "at most %.1f %%, at t = %.3g s; ",
                100 * static_cast<double>(summary.max_inverted_points) /
                    static_cast<double>(std::max<GlobalIndex>(summary.quadrature_points, 1)),
                summary.max_inverted_time);
  return most.data() + (left == 0 ? "none" : std::to_string(left)) + " at the end";
}

/// "damping 63 %, output 26 %, forces 9 %, contact 2 %": shares of the wall time, the largest first; those of
/// less than one per cent are left out, but for contact.
std::string time_text(const RunSummary& summary) {
  const auto spent = [&](std::initializer_list<Phase> phases) {
    double sum = 0;
    for (const auto phase : phases) sum += summary.phases.mean[static_cast<std::size_t>(phase)];
    return 100 * sum / summary.wall_time;
  };
  const double contact = spent({Phase::contact});
  std::vector<std::pair<double, const char*>> shares{
      {spent({Phase::setup}), "set-up"},
      {spent({Phase::force, Phase::stretch_svd}), "forces"},
      {spent({Phase::damping_apply, Phase::damping_solve}), "damping"},
      {spent({Phase::assembly, Phase::static_solve}), "static solves"},
      {contact, "contact"},
      {spent({Phase::filter}), "filter"},
      {spent({Phase::vector_update}), "positions and velocities"},
      {spent({Phase::halo}), "messages"},
      {spent({Phase::io}), "output"}};
  std::sort(shares.rbegin(), shares.rend());
  std::string text;
  for (const auto& [share, what] : shares)
    if (share >= 1 || (share > 0 && share == contact))
      text += (text.empty() ? "" : ", ") + (what + formatted(" %.2g %%", share));
  return text;
}

/// The closing lines: what happened, and where it is.
void print_outcome(const RunSummary& summary, const RunFiles& files) {
  std::printf("%s %s at t = %g s, %lld steps in %s\n", summary.scene.c_str(), summary.outcome.c_str(),
              summary.simulated_time, static_cast<long long>(summary.steps),
              duration_text(summary.wall_time).c_str());
  std::printf("  inverted    %s\n", inversion_text(summary).c_str());
  for (const auto& [body, error] : summary.shape_errors)
    std::printf("  shape       %s: %.3g m RMS from its rest shape\n", body.c_str(), error);
  std::printf("  time        %s\n", time_text(summary).c_str());
  std::printf("  written to  %s\n", files.directory.c_str());
  if (summary.frames > 0) std::printf("  to see it   evert view %s\n", files("run.h5").c_str());
}

/// What fails, fails with where to go on from.
RunEnd run_steps(Simulation& simulation, double end_time, const Observers& observers,
                 const RunArguments& arguments, const std::string& checkpoint) {
  try {
    return run_loop(simulation, end_time, observers.all);
  } catch (const SimulationError& error) {
    const double kept = observers.checkpoints->written_at();
    if (kept < 0) throw;
    throw SimulationError(error.what() + formatted("; the checkpoint of t = %.6g s is kept: ", kept) +
                          restart_command(arguments, checkpoint));
  }
}

int run(MPI_Comm comm, const SceneConfig& scene, const RunArguments& arguments) {
  const double begin = MPI_Wtime();
  const RunFiles files{arguments.output.empty() ? scene.output.directory : arguments.output};
  on_root(comm, [&] {
    require_writable(files("summary.json"));
    std::filesystem::remove(files("summary.json"));  // of a run before: must not speak for one that fails
  });
  auto built = build_scene(comm, scene);
  reject_unused_options(comm, arguments.allow_unknown_options, solvers_of(*built.simulation));
  auto& simulation = *built.simulation;
  if (!arguments.restart.empty()) restore(simulation, arguments.restart, scene.identity);
  if (const auto* filter = simulation.filter()) {
    const auto lines = filter_lines(comm, *filter);
    if (rank_of(comm) == 0 && !arguments.quiet) std::printf("filter: %s\n", lines.front().c_str());
  }
  auto observers = make_observers(scene, simulation, files, arguments);

  const auto end = run_steps(simulation, scene.end_time, observers, arguments, files("checkpoint.h5"));

  if (end == RunEnd::interrupted) observers.checkpoints->write(simulation);
  auto summary = summarize(scene, built, observers, end);
  summary.wall_time = MPI_Wtime() - begin;
  write_summary(comm, files("summary.json"), summary);
  if (rank_of(comm) != 0) return end == RunEnd::interrupted ? interrupted : done;
  if (!arguments.quiet) print_outcome(summary, files);
  if (end == RunEnd::reached_end_time) return done;
  std::fprintf(stderr, "evert: interrupted at t = %g s; go on with: %s\n", simulation.time(),
               restart_command(arguments, files("checkpoint.h5")).c_str());
  return interrupted;
}

}  // namespace

int run_command(MPI_Comm comm, const RunArguments& arguments) {
  if (arguments.help) {
    DampingSolver::print_options(comm);
    EquilibriumSolver::print_options(comm);
    SpanningRows::read_options(comm);
    return done;
  }
  catch_signals();
  const auto scene = load_scene(comm, arguments.scene, arguments.overrides);
  apply_petsc_block(scene);
  require_option_values(scene, arguments.petsc);
  return run(comm, scene, arguments);
}

}  // namespace evert
