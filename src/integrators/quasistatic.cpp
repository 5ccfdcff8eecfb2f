#include "evert/integrators/quasistatic.hpp"

#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/math/nodal.hpp"

#include "scatter_inverted.hpp"
#include <algorithm>
#include <array>

namespace evert {
namespace {

constexpr int most_halvings = 10;
// Parts are sums of powers of two of 1 / load_steps, which need not add up to 1 exactly.
constexpr double whole = 1 - 1e-9;
// Of an energy: less is no improvement.
constexpr double negligible = 1e-6;

void copy_owned(const NodeField& from, NodeField& to) {
  std::copy(from.owned().begin(), from.owned().end(), to.owned().begin());
  to.touched();
}

void update_ghosts(System& system) {
  system.elastic.halo().begin_update(system.x);
  system.elastic.halo().end_update(system.x);
}

/// Collective. Of the elastic forces and of the loads at `t`, which do work from the rest shape on: where the
/// origin of the world is, is of no matter [J].
double potential_energy(System& system, double t) {
  update_ghosts(system);
  NodeField loads(system.mesh);
  system.add_loads(t, loads);
  double energy = system.elastic.energy(system.x);
  const auto& rest = system.mesh.rest_positions;
  for (std::size_t i = 0; i < loads.owned().size(); ++i)
    energy -= loads.owned()[i] * (system.x.owned()[i] - rest[i / 3][i % 3]);
  MPI_Allreduce(MPI_IN_PLACE, &energy, 1, MPI_DOUBLE, MPI_SUM, system.mesh.comm);
  return energy;
}

/// Collective.
std::string untangling_note(System& system, double time, std::uint64_t attempts) {
  update_ghosts(system);
  auto inverted = static_cast<GlobalIndex>(system.elastic.inverted_points(system.x));
  MPI_Allreduce(MPI_IN_PLACE, &inverted, 1, MPI_INT64_T, MPI_SUM, system.mesh.comm);
  return formatted("t = %.6g s: elements were inverted at rest; after %llu searches around them, ", time,
                   static_cast<unsigned long long>(attempts)) +
         (inverted == 0 ? "none is" : std::to_string(inverted) + " points are still inverted");
}

std::string percent(double share) { return formatted("%.4g %%", 100 * share); }

std::string halving_note(double time, double applied, double part,
                         const EquilibriumSolver::Outcome& outcome) {
  return formatted("t = %.6g s: no rest found (", time) + outcome.reason + ") with " +
         percent(applied + part) + " of the change applied, going on with " + percent(applied + part / 2) +
         " of it";
}

}  // namespace

Quasistatic::Quasistatic(const System& system, const QuasistaticOptions& options)
    : options_(options),
      solver_(system, options.tangent),
      unbalanced_(system.mesh),
      withheld_(system.mesh),
      reached_(system.mesh) {}

StepReport Quasistatic::advance(System& system, double dt) {
  StepReport report{.dt = dt};
  const double end = system.time + dt;
  const auto ways = system.prescribed.ways(system.time, end);
  system.update_forces(end);
  copy_owned(system.f, unbalanced_);
  copy_owned(system.x, reached_);
  copy_owned(system.f, withheld_);
  project(ways, withheld_.owned());
  PetscReal load = 0;  // N
  check(VecNorm(withheld_.vec(), NORM_2, &load));
  const double largest = 1.0 / options_.load_steps;
  double applied = 0, part = largest;
  while (applied < whole) {
    const double next = applied + part < whole ? applied + part : 1;
    held_.assign(ways.begin(), ways.end());
    for (auto& c : held_) c.prescribed = (next - applied) * c.prescribed;
    for (std::size_t i = 0; i < withheld_.owned().size(); ++i)
      withheld_.owned()[i] = (1 - next) * unbalanced_.owned()[i];
    const auto outcome = solver_.solve(system.x, held_, withheld_, load, end);
    count(outcome, report);
    if (outcome.converged) {
      copy_owned(system.x, reached_);
      applied = next;
      part = std::min(largest, 2 * part);
      continue;
    }
    report.notes.push_back(halving_note(end, applied, next - applied, outcome));
    copy_owned(reached_, system.x);
    part = (next - applied) / 2;  // of what was tried, which may be less than `part`
    if (part < largest / (1 << most_halvings))
      throw SimulationError(
          "no state of rest was found (" + outcome.reason + ") beyond " + percent(applied) +
          " of the change, not even with " + std::to_string(1 << most_halvings) +
          " times smaller load steps; a smaller integrator.time_step, more integrator.load_steps "
          "or other -quasistatic_snes and -quasistatic_ksp options may help");
  }
  if (options_.untangle > 0) untangle(system, end, load, report);
  system.update_forces(end);
  system.time = end;
  account(system, dt);
  return report;
}

/// A state of rest that is tangled is a minimum of the energy, but hardly ever the lowest around: the nodes
/// of inverted cells are thrown about until a solve from there finds a lower one, then those of a ring of
/// cells around them, and so on until nothing is inverted or luck runs out.
void Quasistatic::untangle(System& system, double end, double load, StepReport& report) {
  for (auto& c : held_) c.prescribed = {};
  std::fill(withheld_.owned().begin(), withheld_.owned().end(), 0.0);
  double lowest = potential_energy(system, end);
  std::uint64_t attempt = 0;
  for (int fruitless = 0; fruitless < options_.untangle; ++fruitless) {
    if (!scatter_inverted(system, held_, attempt + 1, fruitless, system.x)) break;
    ++attempt;
    const auto outcome = solver_.solve(system.x, held_, withheld_, load, end);
    count(outcome, report);
    const double energy = outcome.converged ? potential_energy(system, end) : lowest;
    if (energy < lowest - negligible * std::abs(lowest)) {
      lowest = energy;
      copy_owned(system.x, reached_);
      fruitless = -1;
    } else {
      copy_owned(reached_, system.x);
    }
  }
  if (attempt > 0) report.notes.push_back(untangling_note(system, end, attempt));
}

void Quasistatic::count(const EquilibriumSolver::Outcome& outcome, StepReport& report) const {
  report.newton_iterations += outcome.newton_iterations;
  report.linear_iterations += outcome.linear_iterations;
}

/// Nothing moves; what held nodes exert is what is left of the forces on them.
void Quasistatic::account(System& system, double dt) const {
  for (auto* field : {&system.v, &system.v_change}) {
    std::fill(field->owned().begin(), field->owned().end(), 0.0);
    field->touched();
  }
  for (const double m : system.mass_row_sums()) system.impulses.gravity += dt * m * system.gravity;
  for (const auto& c : held_) {
    const auto force = node_value(system.f.owned(), c.node);
    system.impulses.constraint -= dt * (force - c.free * force);
  }
}

}  // namespace evert
