#include "diagnosis.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/formatted.hpp"
#include "evert/filter/element_limits.hpp"
#include "evert/filter/shape_class.hpp"
#include "evert/math/nodal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <variant>

namespace evert {
namespace {

constexpr double safety = 0.9;  // of the bound, in steps that are recommended: as integrator.safety
constexpr double slack = 1.02;  // a step at its bound is within it

/// The element that allows the shortest step, and how many allow less than `dt`.
struct ShortestStep {
  double step = std::numeric_limits<double>::infinity();  ///< [s]
  GlobalIndex cell = 0;
  std::string region, shape;
  GlobalIndex too_fast = 0;
};

std::string shape_of(const DistributedMesh& mesh, const LocalCells& cells, std::size_t cell) {
  if (cells.type != CellType::tet4) return std::string(name_of(cells.type));
  std::array<Vec3d, 4> corners{};
  for (std::size_t a = 0; a < 4; ++a)
    corners[a] = mesh.rest_positions[static_cast<std::size_t>(cells.nodes[4 * cell + a])];
  return std::string(name_of(shape_class(corners))) + " tetrahedron";
}

/// Collective. By the elements with their own masses, paper B, eq. (9).
ShortestStep shortest_step(System& system, double dt) {
  const auto& mesh = system.mesh;
  const auto limits = element_limits(mesh, system.elastic, system.x);
  double largest = -1;
  std::size_t entry = 0, cell = 0;
  ShortestStep shortest;
  for (std::size_t e = 0; e < limits.own_masses.size(); ++e)
    for (std::size_t c = 0; c < limits.own_masses[e].size(); ++c) {
      const double squared_frequency = limits.own_masses[e][c];
      if (squared_frequency * dt * dt > 4) ++shortest.too_fast;
      if (squared_frequency <= largest) continue;
      largest = squared_frequency;
      entry = e;
      cell = c;
    }
  struct {
    double value;
    int rank;
  } most{largest, rank_of(mesh.comm)};
  MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE_INT, MPI_MAXLOC, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, &shortest.too_fast, 1, MPI_INT64_T, MPI_SUM, mesh.comm);
  std::array<GlobalIndex, 2> numbers{};
  std::array<char, 48> shape{};
  if (most.rank == rank_of(mesh.comm) && largest >= 0) {
    const auto& cells = mesh.cells[entry];
    numbers = {cells.global_ids[cell], cells.region};
    const auto name = shape_of(mesh, cells, cell);
    name.copy(shape.data(), shape.size() - 1);
  }
  MPI_Bcast(numbers.data(), numbers.size(), MPI_INT64_T, most.rank, mesh.comm);
  MPI_Bcast(shape.data(), shape.size(), MPI_CHAR, most.rank, mesh.comm);
  shortest.step = most.value > 0 ? 2 / std::sqrt(most.value) : std::numeric_limits<double>::infinity();
  shortest.cell = numbers[0];
  shortest.region = mesh.regions[static_cast<std::size_t>(numbers[1])];
  shortest.shape = shape.data();
  return shortest;
}

void go_to_rest(System& system) {
  for (LocalIndex i = 0; i < system.mesh.owned_nodes; ++i)
    set_node_value(system.x.owned(), i, system.mesh.rest_positions[static_cast<std::size_t>(i)]);
  system.x.touched();
  system.elastic.halo().begin_update(system.x);
  system.elastic.halo().end_update(system.x);
}

/// Collective. What `auto` would allow, before its safety.
double stable_step_of(const System& system, const Integrator& integrator) {
  double step = std::visit(
      [&](const auto& of) { return std::remove_cvref_t<decltype(of)>::stable_step(system); }, integrator);
  MPI_Allreduce(MPI_IN_PLACE, &step, 1, MPI_DOUBLE, MPI_MIN, system.mesh.comm);
  return step;
}

/// Where a few elements alone are too fast.
std::string filter_advice(const ShortestStep& shortest, const BrokenStep& step, GlobalIndex cells) {
  constexpr double few = 0.1;
  if (shortest.too_fast == 0 || static_cast<double>(shortest.too_fast) > few * static_cast<double>(cells))
    return "";
  return formatted(", or a filter.time_step of %.3g for the %lld of %lld elements that are too fast", step.dt,
                   static_cast<long long>(shortest.too_fast), static_cast<long long>(cells));
}

std::string too_long(System& system, double stable, const ModalFilter* filter, const BrokenStep& step) {
  std::string text =
      formatted("; the step of %.4g s is %.3g times the longest that is sure to be stable at rest", step.dt,
                step.dt / stable);
  if (filter != nullptr)
    return text + formatted(": try an integrator.time_step of %.3g or auto, or a longer filter.time_step",
                            safety * stable);
  const auto shortest = shortest_step(system, step.dt);
  text += formatted(", because of element %lld of '%s', a %s", static_cast<long long>(shortest.cell),
                    shortest.region.c_str(), shortest.shape.c_str());
  text += formatted(": try an integrator.time_step of %.3g or auto", safety * stable);
  return text + filter_advice(shortest, step, system.mesh.total_cells);
}

}  // namespace

std::string what_happened(const System& system, const Soundness::Findings& found,
                          const Soundness& soundness) {
  if (found.ailment == Ailment::unsound_rigid_body)
    return "the motion of '" + system.collisions.obstacles()[found.obstacle]->name() + "' has blown up";
  const auto worst = worst_node(system);
  std::string text = "the motion has blown up";
  if (found.ailment == Ailment::explosion)
    text += formatted(": velocities turned round in each of the last %d steps and grew %.2g times",
                      soundness.watch().turns(), std::sqrt(soundness.watch().growth()));
  else if (found.ailment == Ailment::energy)
    text += formatted(": its energy grew %.2g times, and nothing does work", soundness.energy().growth());
  else
    text += formatted(", %lld of %lld nodes are faster than light or not finite",
                      static_cast<long long>(found.unsound_nodes),
                      static_cast<long long>(system.mesh.total_nodes));
  text += formatted("; first to look at is node %lld of element %lld", static_cast<long long>(worst.node),
                    static_cast<long long>(worst.cell));
  if (!worst.region.empty()) text += " of '" + worst.region + "'";
  text += formatted(" on rank %d", worst.rank);
  return std::isfinite(worst.speed) ? text + formatted(", at %.3g m/s", worst.speed) : text;
}

std::string blame_of_step(System& system, const Integrator& integrator, const ModalFilter* filter,
                          const BrokenStep& step) {
  if (std::holds_alternative<Quasistatic>(integrator) || std::holds_alternative<ExplicitEuler>(integrator))
    return "";
  go_to_rest(system);
  double stable = stable_step_of(system, integrator);
  if (filter != nullptr) stable = std::min(stable, filter->time_step());
  return stable > 0 && step.dt > slack * stable ? too_long(system, stable, filter, step) : "";
}

std::string what_to_try(System& system, const Integrator& integrator, const ModalFilter* filter,
                        const BrokenStep& step) {
  if (step.dt == 0) return "; look at the numbers of the scene";
  if (std::holds_alternative<ExplicitEuler>(integrator))
    return "; explicit_euler is stable with damping and short steps only: try an integrator.method of "
           "symplectic_euler or verlet";
  if (auto blame = blame_of_step(system, integrator, filter, step); !blame.empty()) return blame;
  if (!step.fixed) return "; try a smaller integrator.safety or max_strain_increment";
  return formatted(
      "; the step of %.4g s would be stable at rest, but deformed elements may need shorter ones: "
      "try an integrator.time_step of %.3g or auto",
      step.dt, step.dt / 2);
}

}  // namespace evert
