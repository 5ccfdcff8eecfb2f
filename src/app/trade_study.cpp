#include "trade_study.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/io/files.hpp"
#include "evert/scene/petsc_options.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace evert {
namespace {

using trade::Axis;
using trade::Fate;

constexpr int levels = 3;  // of the reference

std::string default_directory(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  return "trade_" + name;
}

std::vector<std::string> body_names(const SceneConfig& scene) {
  std::vector<std::string> names;
  for (const auto& body : scene.bodies) names.push_back(body.name);
  return names;
}

/// What the scene has that trades accuracy for time, for those who name nothing. Not all of it need be
/// possible.
std::vector<std::string> usual_variations(const SceneConfig& scene, const Simulation& simulation) {
  std::vector<std::string> usual;
  if (scene.filter) usual.emplace_back("filter.time_step=x0.5,x1,x2");
  if (scene.integrator.time_step)
    usual.emplace_back("integrator.time_step=x0.5,x1,x2,x4");
  else if (!simulation.quasistatic() && !scene.filter)
    usual.emplace_back("integrator.safety=x0.25,x0.5,x1");
  if (simulation.solves_for_velocities()) usual.emplace_back("petsc.damping_ksp_rtol=1e-8,1e-4,1e-2");
  usual.emplace_back("bodies.*.mesh.edge_length=x1,x1.5");
  usual.emplace_back("bodies.*.mesh.cells=x1,x0.5");
  return usual;
}

bool is_possible(const SceneSource& source, const std::string& variation, const trade::Automatic& automatic) {
  try {
    static_cast<void>(trade::resolve(source, trade::parse_variation(variation), automatic));
    return true;
  } catch (const UserError&) {
    return false;
  }
}

}  // namespace

TradeStudy::TradeStudy(MPI_Comm comm, const TradeArguments& arguments, std::ostream& out)
    : comm_(comm),
      arguments_(arguments),
      out_(out),
      source_(comm, arguments.run.scene, arguments.run.overrides) {
  const auto scene = source_.variant();
  require_option_values(scene, arguments.run.petsc);
  name_ = scene.name;
  directory_ = arguments.out.empty() ? default_directory(scene.name) : arguments.out;
  on_root(comm, [&] { require_writable(path("trade.csv")); });
  auto probes = std::vector<trade::Probe>();
  for (const auto& text : arguments.probes) probes.push_back(trade::parse_probe(text, body_names(scene)));
  look_at_scene(comm, scene, arguments.run.allow_unknown_options,
                [&](BuiltScene& built) { axes_ = find_axes(*built.simulation, scene); });
  grid_ = trade::grid_of(axes_);
  ratio_ = trade::refinement_ratio(axes_);
  const auto finest = trade::reference_of(source_, axes_, automatic_, 0, ratio_, arguments.reference);
  look_at_scene(comm, source_.variant(finest), arguments.run.allow_unknown_options, [&](BuiltScene& built) {
    runs_.emplace(comm, source_, trade::make_plan(built, scene.end_time, arguments.samples, probes),
                  directory_, arguments.run.allow_unknown_options);
  });
  if (arguments.limit) runs_->limit(*arguments.limit);
}

std::string TradeStudy::path(const std::string& file) const {
  return (std::filesystem::path(directory_) / file).string();
}

void TradeStudy::say(const std::string& text) const {
  if (rank_of(comm_) == 0) out_ << text << std::flush;
}

void TradeStudy::say_detail(const std::string& text) const {
  if (!arguments_.run.quiet) say(text);
}

std::vector<Axis> TradeStudy::find_axes(Simulation& simulation, const SceneConfig& scene) {
  const double step = simulation.suggested_time_step();
  if (std::isfinite(step)) automatic_["integrator.time_step"] = step;
  automatic_["integrator.safety"] = scene.integrator.safety;
  automatic_["integrator.max_strain_increment"] = scene.integrator.max_strain_increment;
  if (simulation.filter() != nullptr && std::isfinite(simulation.filter()->time_step()))
    automatic_["filter.time_step"] = simulation.filter()->time_step();
  auto variations = arguments_.variations;
  if (variations.empty())
    for (const auto& usual : usual_variations(scene, simulation))
      if (is_possible(source_, usual, automatic_)) variations.push_back(trade::parse_variation(usual));
  if (variations.empty())
    throw UserError("nothing of the scene varies by itself: name it with -vary key=value,value");
  std::vector<Axis> axes;
  for (const auto& variation : variations) {
    axes.push_back(trade::resolve(source_, variation, automatic_));
    std::string line = "vary " + variation.key + ":";
    for (const auto& value : variation.values) line += " " + value;
    say(line + "\n");
  }
  return axes;
}

bool TradeStudy::make_reference() {
  // Where nothing that varies can be finer, the step can.
  auto refined_axes = axes_;
  const bool only_choices =
      std::ranges::all_of(axes_, [](const Axis& axis) { return axis.kind == trade::AxisKind::choice; });
  if (only_choices && automatic_.contains("integrator.time_step")) {
    const char* key = source_.variant().integrator.time_step ? "integrator.time_step" : "integrator.safety";
    refined_axes.push_back(trade::resolve(source_, {key, {"x1"}}, automatic_));
  }
  std::array<trade::RunRecord, levels> runs;
  for (int level = 0; level < levels; ++level) {
    const auto overrides =
        trade::reference_of(source_, refined_axes, automatic_, level, ratio_, arguments_.reference);
    std::string line = formatted("reference %d of %d:", level + 1, levels);
    for (const auto& text : overrides) line += " " + text;
    say_detail(line + "\n");
    auto run = runs_->run(overrides, 1);
    if (!run) return false;
    if (run->fate != Fate::finished)
      throw SimulationError(
          std::string("the reference is ") + name_of(run->fate) + " (" + run->message +
          "): give a smaller step or a coarser mesh as one of the values, or -reference key=value");
    runs[static_cast<std::size_t>(level)] = std::move(*run);
  }
  if (rank_of(comm_) == 0) {
    quality_ = trade::assess_reference(runs_->plan(), runs[0].measured, runs[1].measured, runs[2].measured);
    reference_ = trade::best_reference(quality_, runs[1].measured, runs[2].measured);
  }
  MPI_Bcast(&quality_, sizeof(quality_), MPI_BYTE, 0, comm_);
  describe_reference();
  // What takes longer than the finest run is of no use.
  constexpr double patience = 2, at_least = 5;
  const double cpu = runs[2].cost() * runs[2].reached / size_of(comm_);
  if (!arguments_.limit) runs_->limit(std::max(at_least, patience * cpu));
  return true;
}

void TradeStudy::describe_reference() const {
  const auto& q = quality_;
  std::string text = "reference: refinements by " + formatted("%.3g", ratio_) +
                     " change the displacement by " + trade::percent(q.first) + ", then " +
                     trade::percent(q.second) + "; ";
  if (q.converges)
    text += formatted("the finest run is wrong by %s (between %s and %s);\n", trade::percent(q.error).c_str(),
                      trade::percent(q.least).c_str(), trade::percent(q.most).c_str()) +
            "           errors are against what the refinements lead to\n";
  else
    text += formatted(
        "they show no order:\n           the finest run, which errors are against, may be wrong by %s\n",
        trade::percent(q.most).c_str());
  say(text);
}

std::optional<trade::Trial> TradeStudy::run(const trade::Choice& choice, int repetitions) {
  const auto record = runs_->run(trade::overrides_of(axes_, choice), repetitions);
  if (!record) return std::nullopt;
  trade::Trial trial{.choice = choice,
                     .label = trade::label_of(axes_, choice),
                     .fate = record->fate,
                     .message = record->message,
                     .cost = record->cost(),
                     .memory = record->memory,
                     .steps = record->steps,
                     .nodes = record->nodes,
                     .errors = {}};
  if (!trial.usable()) return trial;
  if (rank_of(comm_) == 0) trial.errors = trade::compare(runs_->plan(), record->measured, reference_);
  MPI_Bcast(&trial.errors, sizeof(trial.errors), MPI_BYTE, 0, comm_);
  constexpr double astray = 10;
  if (!(trial.errors.displacement < astray)) {
    trial.fate = Fate::unstable;
    trial.message = "it ended, but went astray: its error is " + trade::percent(trial.errors.displacement);
  }
  return trial;
}

std::string TradeStudy::command_of(const trade::Choice& choice) const {
  auto run = arguments_.run;
  run.quiet = false;
  const auto overrides = trade::overrides_of(axes_, choice);
  run.overrides.insert(run.overrides.end(), overrides.begin(), overrides.end());
  return run_line(run);
}

int interrupted_trade(MPI_Comm comm, const TradeStudy& study) {
  constexpr int interrupted = 130;
  if (rank_of(comm) == 0)
    std::fprintf(stderr, "evert: interrupted; the same command goes on with what is in %s\n",
                 study.directory().c_str());
  return interrupted;
}

}  // namespace evert
