#include "evert/app/bench_command.hpp"

#include "evert/app/command_line.hpp"
#include "evert/app/observer.hpp"
#include "evert/app/run_loop.hpp"
#include "evert/bench/elements.hpp"
#include "evert/bench/kernel_report.hpp"
#include "evert/bench/step_profile.hpp"
#include "evert/core/collective.hpp"
#include "evert/io/files.hpp"
#include "evert/scene/build.hpp"
#include "evert/scene/load.hpp"
#include "evert/scene/petsc_options.hpp"

#include "command_options.hpp"
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace evert {
namespace {

constexpr const char* help = R"(evert bench: measures Evert on this machine; under mpirun all ranks together

evert bench kernels [options]     rates of the element kernels: tetrahedra, points of hexahedra, SVDs and
                                  products with the damping operator per second, best and median of many
                                  short samples; beside them what they are a multiple of (a naive code,
                                  PETSc's BAIJ product), and the share of what the processor allows
  -bench_size S[,S...]            small, 100K, 1M: so many tetrahedra; 100K,1M unless given
  -bench_seconds T                processor time for each kernel and size; 2 unless given
  -bench_json FILE                the figures, for programs

evert bench elements [options]    a bending beam filled with hex8, 5, 6 or bcc tetrahedra a cube, wedge6 and
                                  tet10: nodes, quadrature points, cost of the forces, stable time step and
                                  error, and what a Poisson's ratio near 0.5 does to each
  -bench_size S                   small or full, how fine the meshes are; full unless given
  -bench_seconds T                processor time for each mesh; 0.5 unless given
  -bench_json FILE                the figures, for programs
  -bench_svg FILE                 error against cost, as a picture

evert bench step scene.yaml [options]     what the time of the steps of a scene goes into, without output;
                                  options are those of evert run

The environment variable EVERT_CPU_LEVEL (v2, v3, v4) chooses narrower kernels than this processor could run.
)";

/// The size of that name, for a command.
template <class Size>
const Size& size_of_name(std::span<const Size> all, const std::string& name, const std::string& command) {
  std::vector<std::string> names;
  for (const auto& size : all) names.push_back(size.name);
  const auto found = std::ranges::find(all, name, &Size::name);
  if (found == all.end())
    throw UserError("evert bench " + command + ": -bench_size is '" + name + "': must be " + list_of(names) +
                    did_you_mean(name, names));
  return *found;
}

std::vector<bench::KernelSize> sizes_from(const std::string& list) {
  std::vector<bench::KernelSize> sizes;
  for (std::size_t begin = 0; begin <= list.size();) {
    const auto end = std::min(list.find(',', begin), list.size());
    sizes.push_back(size_of_name(bench::kernel_sizes(), list.substr(begin, end - begin), "kernels"));
    begin = end + 1;
  }
  return sizes;
}

double seconds_from(const CommandOptions& options, const std::string& command, double otherwise) {
  if (!options.has("bench_seconds")) return otherwise;
  constexpr double longest = 3600;
  const double seconds = options.number("bench_seconds");
  if (!(seconds > 0 && seconds <= longest))
    throw UserError("evert bench " + command + ": -bench_seconds must be above 0 and at most 3600, not " +
                    options.text("bench_seconds"));
  return seconds;
}

int elements_command(MPI_Comm comm, std::span<const std::string> arguments, std::ostream& out) {
  const CommandOptions options("evert bench elements", arguments,
                               {"bench_size", "bench_seconds", "bench_json", "bench_svg"}, {}, {});
  const auto& size = size_of_name(
      bench::element_sizes(), options.has("bench_size") ? options.text("bench_size") : "full", "elements");
  const double seconds = seconds_from(options, "elements", 0.5);
  const auto json = options.has("bench_json") ? options.text("bench_json") : "";
  const auto svg = options.has("bench_svg") ? options.text("bench_svg") : "";
  on_root(comm, [&] {
    for (const auto& file : {json, svg})
      if (!file.empty()) require_writable(file);
  });
  const auto report = bench::measure_elements(comm, size, seconds);
  on_root(comm, [&] {
    print_table(report, out);
    if (!json.empty()) write_file(json, bench::json_text(report));
    if (!svg.empty()) write_file(svg, bench::svg_text(report));
    for (const auto& file : {json, svg})
      if (!file.empty()) out << "\nwrote " << file << '\n';
  });
  return 0;
}

int kernels_command(MPI_Comm comm, std::span<const std::string> arguments, std::ostream& out) {
  const CommandOptions options("evert bench kernels", arguments,
                               {"bench_size", "bench_seconds", "bench_json"}, {}, {});
  const auto sizes = sizes_from(options.has("bench_size") ? options.text("bench_size") : "100K,1M");
  const double seconds = seconds_from(options, "kernels", 2.0);
  const auto json = options.has("bench_json") ? options.text("bench_json") : "";
  on_root(comm, [&] {
    if (!json.empty()) require_writable(json);
  });

  const bool reports = rank_of(comm) == 0;
  bench::KernelReport report{bench::current_setting(comm), {}};
  if (reports) print_head(report.setting, out);
  for (const auto& size : sizes) {
    report.sizes.push_back(bench::measure_kernels(comm, size, seconds));
    if (reports) print_table(report.sizes.back(), out);
    out.flush();
  }
  on_root(comm, [&] {
    if (!json.empty()) write_file(json, bench::json_text(report));
  });
  if (reports && !json.empty()) out << "\nwrote " << json << '\n';
  return 0;
}

/// Makes the run stop where frames would be written, without writing any, and counts.
class FrameTimes final : public Observer {
 public:
  explicit FrameTimes(const std::optional<double>& per_second) {
    if (per_second) schedule_.emplace(1 / *per_second);
  }
  [[nodiscard]] double next_stop(double time) const override {
    return schedule_ ? schedule_->next_after(time) : std::numeric_limits<double>::infinity();
  }
  void observe(Simulation& /*simulation*/, const StepReport& report) override {
    cg_iterations += report.cg_iterations;
  }
  std::int64_t cg_iterations = 0;

 private:
  std::optional<Schedule> schedule_;
};

int step_command(MPI_Comm comm, std::span<const std::string> arguments, std::ostream& out) {
  const auto run = parse_run_arguments(arguments, "bench step");
  const auto scene = load_scene(comm, run.scene, run.overrides);
  apply_petsc_block(scene);
  auto built = build_scene(comm, scene);
  reject_unused_options(comm, run.allow_unknown_options, solvers_of(*built.simulation));

  auto frames = std::make_unique<FrameTimes>(scene.output.frames_per_second);
  const auto& counted = *frames;
  std::vector<std::unique_ptr<Observer>> observers;
  observers.push_back(std::move(frames));
  const bench::StepProfiler profiler(*built.simulation);
  run_loop(*built.simulation, scene.end_time, observers);
  constexpr double ceiling_seconds = 0.5;
  const auto profile = profiler.finish(ceiling_seconds);
  const auto setting = bench::current_setting(comm);
  if (rank_of(comm) == 0) print_profile(profile, scene.name, counted.cg_iterations, setting, out);
  return 0;
}

}  // namespace

int bench_command(MPI_Comm comm, std::span<const std::string> arguments, std::ostream& out) {
  const std::vector<std::string> commands{"kernels", "elements", "step"};
  if (asks_for_help(arguments)) {
    if (rank_of(comm) == 0) out << help;
    return 0;
  }
  if (arguments.empty())
    throw UserError("evert bench needs a command: " + list_of(commands) + "; see evert bench --help");
  const auto& command = arguments.front();
  if (command == "step") return step_command(comm, arguments.subspan(1), out);
  if (command == "elements") return elements_command(comm, arguments.subspan(1), out);
  if (command == "kernels") return kernels_command(comm, arguments.subspan(1), out);
  throw UserError("evert bench: there is no command '" + command + "': must be " + list_of(commands) +
                  did_you_mean(command, commands));
}

}  // namespace evert
