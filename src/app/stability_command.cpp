#include "evert/app/stability_command.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/formatted.hpp"
#include "evert/filter/collatz_wielandt.hpp"
#include "evert/filter/element_limits.hpp"
#include "evert/filter/mode_energy.hpp"
#include "evert/io/checkpoint.hpp"
#include "evert/io/files.hpp"
#include "evert/math/nodal.hpp"
#include "evert/scene/build.hpp"
#include "evert/scene/load.hpp"
#include "evert/scene/petsc_options.hpp"

#include "stability_report.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

namespace evert {
namespace {

ShapeClass shape_of(const DistributedMesh& mesh, const LocalCells& cells, std::size_t cell) {
  if (cells.type != CellType::tet4) return ShapeClass::well_shaped;
  std::array<Vec3d, 4> corners{};
  for (std::size_t a = 0; a < 4; ++a)
    corners[a] = mesh.rest_positions[static_cast<std::size_t>(cells.nodes[4 * cell + a])];
  return shape_class(corners);
}

/// Collective. All records on rank 0, by cell.
std::vector<ElementRecord> gathered(MPI_Comm comm, const std::vector<ElementRecord>& own) {
  const bool root = rank_of(comm) == 0;
  MPI_Datatype record = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(sizeof(ElementRecord), MPI_BYTE, &record);
  MPI_Type_commit(&record);
  const int count = static_cast<int>(own.size());
  std::vector<int> counts(static_cast<std::size_t>(size_of(comm))), begins;
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, comm);
  int total = 0;
  for (const int of_rank : counts) {
    begins.push_back(total);
    total += of_rank;
  }
  std::vector<ElementRecord> all(root ? static_cast<std::size_t>(total) : 0);
  MPI_Gatherv(own.data(), count, record, all.data(), counts.data(), begins.data(), record, 0, comm);
  MPI_Type_free(&record);
  std::ranges::sort(all, {}, &ElementRecord::cell);
  return all;
}

/// Collective.
StabilityFindings findings_at(NodeField& x, const Simulation& simulation) {
  const auto& mesh = simulation.mesh();
  const auto& elastic = simulation.elastic();
  MassScaledStiffness stiffness(mesh, elastic);
  stiffness.assemble(x);
  StabilityFindings found;
  found.collatz_wielandt = collatz_wielandt_bound(stiffness.mat());
  if (!std::isfinite(found.collatz_wielandt))
    throw SimulationError("the stiffness at this state is not finite: no step is stable");
  const auto mode = fastest_mode(stiffness);
  const auto limits = element_limits(mesh, elastic, x);
  found.truth = mode.squared_frequency;
  found.eq9 = limits.largest_of_own;
  found.eq8 = limits.most_cells_a_node * limits.largest_of_nodal;
  found.lanczos = lanczos_estimate(stiffness);
  double step = elastic.stable_step(x).undamped;
  MPI_Allreduce(MPI_IN_PLACE, &step, 1, MPI_DOUBLE, MPI_MIN, mesh.comm);
  found.balanced = 4 / (step * step);

  std::vector<std::vector<double>> energies;
  if (found.truth > 0) energies = energy_shares(mesh, elastic, x, mode);
  std::vector<ElementRecord> own;
  for (std::size_t b = 0; b < mesh.cells.size(); ++b) {
    const auto& cells = mesh.cells[b];
    for (std::size_t c = 0; c < cells.global_ids.size(); ++c)
      own.push_back({cells.global_ids[c], cells.region, cells.type, shape_of(mesh, cells, c),
                     limits.own_masses[b][c], limits.nodal_masses[b][c],
                     energies.empty() ? 0 : energies[b][c]});
  }
  found.elements = gathered(mesh.comm, own);
  return found;
}

NodeField rest_state(const DistributedMesh& mesh) {
  NodeField x(mesh);
  for (LocalIndex i = 0; i < mesh.owned_nodes; ++i)
    set_node_value(x.owned(), i, mesh.rest_positions[static_cast<std::size_t>(i)]);
  return x;
}

/// Collective. Whether any rank's nodes are elsewhere than at rest.
bool is_deformed(const Simulation& simulation, const NodeField& rest) {
  const auto now = simulation.positions().owned();
  int deformed = std::ranges::equal(now, rest.owned()) ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &deformed, 1, MPI_INT, MPI_MAX, simulation.mesh().comm);
  return deformed != 0;
}

std::string time_step_text(const SceneConfig& scene, Simulation& simulation) {
  const double step = simulation.suggested_time_step();
  if (simulation.quasistatic())
    return "time step: none limits states of rest (integrator.method: quasistatic)";
  if (scene.integrator.time_step) return formatted("time step: %.5g ms, fixed", 1e3 * step);
  if (std::isinf(step)) return "time step: nothing limits it at this state";
  return formatted("time step: %.5g ms is what auto takes at this state", 1e3 * step);
}

/// Collective. What elements of a compliant filter have beside their implicit stiffness is what they would be
/// softened to, and has the limit of the steps.
void look_at_the_explicit_part(MPI_Comm comm, SceneConfig& scene) {
  if (!scene.filter || scene.filter->constraints == FilterConstraints::none) return;
  scene.filter->constraints = FilterConstraints::none;
  SpanningRows::read_options(comm);  // which are not wrong here
}

}  // namespace

StabilityArguments parse_stability_arguments(std::span<const std::string> arguments) {
  StabilityArguments parsed;
  std::vector<std::string> of_run;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const auto& argument = arguments[i];
    if (argument != "-o" && argument != "--o") {
      of_run.push_back(argument);
    } else {
      if (i + 1 == arguments.size()) throw UserError("-o needs a value: evert stability -help shows which");
      parsed.table = arguments[++i];
    }
  }
  parsed.run = parse_run_arguments(of_run, "stability");
  if (!parsed.run.output.empty())
    throw UserError("-output is of evert run: the table of evert stability goes to -o FILE");
  return parsed;
}

int stability_command(MPI_Comm comm, const StabilityArguments& arguments, std::ostream& out) {
  const auto& run = arguments.run;
  const bool root = rank_of(comm) == 0;
  if (run.help) {
    if (root) out << stability_usage();
    return 0;
  }
  if (!arguments.table.empty()) on_root(comm, [&] { require_writable(arguments.table); });
  auto scene = load_scene(comm, run.scene, run.overrides);
  if (scene.integrator.mass == MassForm::consistent)
    throw UserError(
        "integrator.mass: must be lumped for evert stability: it knows no limit of consistent masses");
  apply_petsc_block(scene);
  require_option_values(scene, run.petsc);
  look_at_the_explicit_part(comm, scene);
  const auto built = build_scene(comm, scene);
  auto& simulation = *built.simulation;
  if (!run.restart.empty()) {
    const auto state = read_checkpoint(simulation.mesh(), run.restart, scene.identity);
    simulation.restore(state.nodes(), state.scalars, state.flow);
  }
  auto x = rest_state(simulation.mesh());
  const bool deformed = is_deformed(simulation, x);
  auto findings = findings_at(x, simulation);
  auto live = solvers_of(simulation);
  live.stability = true;
  reject_unused_options(comm, run.allow_unknown_options, live);
  const auto& regions = simulation.mesh().regions;
  if (root) {
    out << scene.name << " (" << scene.file << "): " << simulation.mesh().total_nodes << " nodes, "
        << simulation.mesh().total_cells << " elements; held nodes count as free\n\n";
    write_stability(findings, "at rest", regions, out);
  }
  if (deformed && simulation.filter() && std::isfinite(simulation.filter()->time_step())) {
    if (root)
      out << formatted("\nat t = %g s: not looked at: filtered elements have a stiffness at rest only\n",
                       simulation.time());
  } else if (deformed) {
    std::ranges::copy(simulation.positions().owned(), x.owned().begin());
    findings = findings_at(x, simulation);
    if (root) {
      out << '\n';
      write_stability(findings, formatted("at t = %g s", simulation.time()), regions, out);
    }
  }
  const auto time_step = time_step_text(scene, simulation);
  if (root) out << '\n' << time_step << '\n';
  if (arguments.table.empty()) return 0;
  on_root(comm, [&] {
    std::ofstream file(arguments.table);
    write_element_table(findings, regions, file);
    file.close();
    if (!file) throw UserError("-o " + arguments.table + ": the table could not be written");
    out << "table of all elements: " << arguments.table << '\n';
  });
  return 0;
}

std::string stability_usage() {
  return R"(evert stability SCENE.yaml [options]: how long a step may be, and which elements make it short

  -o table.csv               all elements: shape, steps that they allow by themselves, share of the vibration
  -restart file              at the state of a checkpoint too
  -set key=value             override a value of the scene, as in evert run; repeatable
  -allow_unknown_options     do not stop at PETSc options that nothing reads
  -stability_eps_tol 1e-9, -stability_eps_ncv, -stability_eps_monitor, ...   SLEPc's solver of the true limit

On any number of ranks: mpirun -n 4 evert stability SCENE.yaml. At rest, and at the start or the checkpoint where that is
another state: the true limit of explicit elastic forces, 2/ω of the fastest vibration, without damping; what rigorous bounds
and an estimate of it are; the elements by their shapes and by the steps that they allow; and the ten with the shortest.
)";
}

}  // namespace evert
