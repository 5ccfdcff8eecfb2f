#include "trade_runs.hpp"

#include "evert/app/run_loop.hpp"
#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/core/memory_in_use.hpp"
#include "evert/core/petsc.hpp"
#include "evert/core/version.hpp"
#include "evert/scene/petsc_options.hpp"

#include <petscsys.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <utility>

namespace evert {
namespace {

using trade::Fate;
using trade::RunRecord;

/// The PETSc options of a scene for the life of the object, those left out that the command line has.
class OptionsOfScene {
 public:
  explicit OptionsOfScene(const SceneConfig& scene) {
    for (const auto& [name, value] : scene.petsc) {
      PetscBool given = PETSC_FALSE;
      check(PetscOptionsHasName(nullptr, nullptr, ("-" + name).c_str(), &given));
      if (given == PETSC_FALSE) ours_.push_back("-" + name);
    }
    apply_petsc_block(scene);
  }
  ~OptionsOfScene() {
    for (const auto& name : ours_) static_cast<void>(PetscOptionsClearValue(nullptr, name.c_str()));
  }
  OptionsOfScene(const OptionsOfScene&) = delete;
  OptionsOfScene& operator=(const OptionsOfScene&) = delete;

 private:
  std::vector<std::string> ours_;
};

double bytes_of(const trade::Measurement& m) {
  return static_cast<double>(sizeof(double) *
                             (m.displacement.capacity() + m.probes.capacity() + m.kinetic.capacity() +
                              m.potential.capacity() + m.volume.capacity()));
}

double seconds_since(std::clock_t begin) {
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

double sum(MPI_Comm comm, double value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, comm);
  return value;
}

/// Measures, and ends the run when it has taken too long.
class TradeObserver final : public Observer {
 public:
  TradeObserver(const trade::SamplePlan& plan, const Simulation& simulation, double limit)
      : sampler_(plan, simulation), stops_(simulation.quasistatic()), limit_(limit), begin_(std::clock()) {}

  [[nodiscard]] double next_stop(double /*time*/) const override {
    return stops_ ? sampler_.next_time() : std::numeric_limits<double>::infinity();
  }
  void observe(Simulation& simulation, const StepReport& /*report*/) override {
    sampler_.observe(simulation);
    if (cpu_seconds() <= limit_) return;
    too_slow_ = true;
    simulation.request_stop();
  }

  /// Of this rank, without measuring [s].
  [[nodiscard]] double cpu_seconds() const { return seconds_since(begin_) - sampler_.cpu_seconds(); }
  [[nodiscard]] bool too_slow() const { return too_slow_; }
  [[nodiscard]] const trade::Sampler& sampler() const { return sampler_; }

 private:
  trade::Sampler sampler_;
  bool stops_;
  double limit_;
  std::clock_t begin_;
  bool too_slow_ = false;
};

RunRecord refused(const UserError& error) {
  RunRecord record;
  record.fate = Fate::refused;
  record.message = error.what();
  return record;
}

std::string text_of(const trade::SamplePlan& plan) {
  std::string text = formatted("%.17g %d %d", plan.end_time, plan.fields, plan.probe_times);
  const auto add = [&](const trade::BodyPoint& p) {
    text += formatted("\n%s %.17g %.17g %.17g", p.body.c_str(), p.position[0], p.position[1], p.position[2]);
  };
  for (const auto& point : plan.points) add(point);
  for (const auto& probe : plan.probes) {
    add(probe.point);
    text += " " + probe.name;
  }
  return text;
}

}  // namespace

void look_at_scene(MPI_Comm comm, const SceneConfig& scene, bool allow_unknown_options,
                   const std::function<void(BuiltScene&)>& look) {
  const OptionsOfScene options(scene);
  auto built = build_scene(comm, scene);
  reject_unused_options(comm, allow_unknown_options, solvers_of(*built.simulation));
  look(built);
}

TradeRuns::TradeRuns(MPI_Comm comm, const SceneSource& source, trade::SamplePlan plan,
                     const std::string& directory, bool allow_unknown_options)
    : comm_(comm),
      source_(source),
      plan_(std::move(plan)),
      store_((std::filesystem::path(directory) / "runs").string()),
      allow_unknown_options_(allow_unknown_options),
      plan_text_(text_of(plan_)) {}

std::string TradeRuns::identity_of(const trade::Overrides& overrides) const {
  char* options = nullptr;
  check(PetscOptionsGetAll(nullptr, &options));
  const std::string petsc = options;
  check(PetscFree(options));
  return source_.variant(overrides).text + "\n" + petsc + "\n" + std::string(version()) +
         formatted(" on %d ranks\n", size_of(comm_)) + plan_text_;
}

/// Collective. What decides about further runs goes to all ranks.
std::optional<RunRecord> TradeRuns::found(const std::string& identity) const {
  std::optional<RunRecord> record;
  if (rank_of(comm_) == 0) record = store_.find(identity);
  std::array<std::int64_t, 3> counts{};  // found, fate, repetitions
  std::array<double, 2> seconds{};       // simulated, least of the processor
  if (record) {
    counts = {1, static_cast<std::int64_t>(record->fate),
              static_cast<std::int64_t>(record->cpu_seconds.size())};
    seconds = {record->reached, record->cost() * record->reached};
  }
  MPI_Bcast(counts.data(), 3, MPI_INT64_T, 0, comm_);
  MPI_Bcast(seconds.data(), 2, MPI_DOUBLE, 0, comm_);
  if (counts[0] == 0 || record) return record;
  RunRecord elsewhere;
  elsewhere.fate = static_cast<Fate>(counts[1]);
  elsewhere.cpu_seconds.assign(static_cast<std::size_t>(counts[2]), seconds[1]);
  elsewhere.reached = seconds[0];
  return elsewhere;
}

std::optional<RunRecord> TradeRuns::run(const trade::Overrides& overrides, int repetitions) {
  std::string identity;
  try {
    identity = identity_of(overrides);
  } catch (const UserError& error) {
    return refused(error);
  }
  auto record = found(identity);
  // More patience than then makes it worth another try.
  constexpr double more = 1.1;
  if (record && record->fate == Fate::too_slow &&
      more * record->cpu_seconds.front() < limit_ * size_of(comm_))
    record.reset();
  const auto wanted = static_cast<std::size_t>(repetitions);
  const auto wants_more = [&] {
    return !record || (record->fate == Fate::finished && record->cpu_seconds.size() < wanted);
  };
  while (wants_more()) {
    auto once = simulate(overrides);
    if (!once) return std::nullopt;
    if (record && once->fate == Fate::finished)
      once->cpu_seconds.insert(once->cpu_seconds.begin(), record->cpu_seconds.begin(),
                               record->cpu_seconds.end());
    record = std::move(once);
    on_root(comm_, [&] { store_.keep(identity, *record); });
  }
  return record;
}

std::optional<RunRecord> TradeRuns::simulate(const trade::Overrides& overrides) {
  ++made_;
  const auto scene = source_.variant(overrides);
  const OptionsOfScene options(scene);
  const auto heap_before = static_cast<double>(memory_in_use());
  BuiltScene built;
  try {
    built = build_scene(comm_, scene);
  } catch (const UserError& error) {
    return refused(error);
  }
  reject_unused_options(comm_, allow_unknown_options_, solvers_of(*built.simulation));
  return run_built(built, heap_before);
}

std::optional<RunRecord> TradeRuns::run_built(BuiltScene& built, double heap_before) {
  auto& simulation = *built.simulation;
  RunRecord record;
  std::vector<std::unique_ptr<Observer>> observers;
  observers.push_back(std::make_unique<TradeObserver>(plan_, simulation, limit_));
  const auto& observer = static_cast<const TradeObserver&>(*observers.front());
  auto end = RunEnd::reached_end_time;
  try {
    end = run_loop(simulation, plan_.end_time, observers);
  } catch (const SimulationError& error) {
    record.fate = Fate::unstable;
    record.message = error.what();
  }
  record.cpu_seconds = {sum(comm_, observer.cpu_seconds())};
  if (end == RunEnd::interrupted) {
    if (sum(comm_, observer.too_slow() ? 1 : 0) == 0) return std::nullopt;
    record.fate = Fate::too_slow;
    record.message = formatted("stopped at t = %g s", simulation.time());
  }
  record.reached = simulation.time();
  record.steps = static_cast<double>(simulation.steps());
  record.nodes = static_cast<double>(simulation.mesh().total_nodes);
  if (record.fate == Fate::finished) record.measured = observer.sampler().collect();
  observers.clear();
  record.memory = sum(
      comm_, std::max(0.0, static_cast<double>(memory_in_use()) - heap_before - bytes_of(record.measured)));
  return record;
}

}  // namespace evert
