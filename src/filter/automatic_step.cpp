#include "evert/filter/automatic_step.hpp"

#include "evert/core/error.hpp"

#include "spare_mass.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace evert {
namespace {

constexpr std::array multiples{1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0};

// Of a filtered cell in unfiltered ones, by `evert bench kernels`; docs/modal-filter.md has the run.
struct ModelCost {
  std::string_view model;
  double cost;
};
constexpr std::array model_costs{ModelCost{RotatedLinear::name, 2.0},
                                 ModelCost{NeoHookean::name, 2.2},
                                 ModelCost{StVenantKirchhoff::name, 2.3},
                                 ModelCost{MooneyRivlin::name, 2.1},
                                 ModelCost{Spline::name, 2.3},
                                 ModelCost{StableNeoHookean::name, 2.3}};

/// With `compliant`, the share in the solve for the strains of a cell that is counted, which is by
/// `spare_mass`: `adaptive` has a fifth of them. docs/modal-filter.md has the run.
double compliant_cost(FilterSelection selection) { return selection == FilterSelection::adaptive ? 20 : 100; }

/// Collective. The step that the integrator makes of the body at rest, unfiltered.
double own_step(const FilterProblem& problem, const ModalFilterOptions& options) {
  NodeField rest(problem.mesh);
  for (std::size_t i = 0; i < rest.local().size(); ++i)
    rest.local()[i] = problem.mesh.rest_positions[i / 3][i % 3];
  const auto bound = problem.elastic.stable_step(rest);
  // As Newmark::stable_step() and the explicit schemes have it.
  double step = options.implicit_damping ? std::max(bound.undamped, bound.damped / 2) : bound.undamped;
  MPI_Allreduce(MPI_IN_PLACE, &step, 1, MPI_DOUBLE, MPI_MIN, problem.mesh.comm);
  return options.integrator_safety * options.stability_constant / 2 * step;
}

/// What a filter does to the cells of a region, of one rank or of all.
struct OfRegion {
  double mass = 0, softened_mass = 0;
  double cells = 0, filtered = 0;
  double extra_cost = 0;  // in unfiltered cells
  double slow = 0;        // cells below the limit even with all the mass of their nodes
};

/// Of the cells one by one, whatever the step.
struct CellEigenvalues {
  std::vector<double> own;               // against their own mass [1/s²]
  std::vector<double> against_all_mass;  // of their nodes
};

/// Collective. Per region, summed over ranks.
std::vector<OfRegion> count(const FilterProblem& problem, const CellEigenvalues& eigenvalues,
                            const ModalFilterOptions& options, double limit) {
  const auto& mesh = problem.mesh;
  std::vector<OfRegion> regions(mesh.regions.size());
  const SpareMass spare(problem, eigenvalues.own, limit);
  std::size_t c = 0;
  for (const auto& entry : mesh.cells) {
    auto& region = regions[static_cast<std::size_t>(entry.region)];
    const double extra = options.constraints == FilterConstraints::compliant
                             ? compliant_cost(options.selection) - 1
                             : relative_cost(problem.elastic.properties(entry.region).material) - 1;
    for (LocalIndex i = 0; i < entry.size(); ++i, ++c) {
      const double mass = problem.cells[c].density * problem.cells[c].shape.volume;
      region.mass += mass;
      region.cells += 1;
      region.slow += eigenvalues.against_all_mass[c] <= limit ? 1 : 0;
      const bool filtered =
          options.selection == FilterSelection::paper ? eigenvalues.own[c] > limit : spare.clamp(c).limit > 0;
      if (!filtered) continue;
      region.softened_mass += mass;
      region.filtered += 1;
      region.extra_cost += extra;
    }
  }
  static_assert(sizeof(OfRegion) == 6 * sizeof(double));
  MPI_Allreduce(MPI_IN_PLACE, regions.data(), static_cast<int>(6 * regions.size()), MPI_DOUBLE, MPI_SUM,
                mesh.comm);
  return regions;
}

FilterCandidate candidate(const FilterProblem& problem, const CellEigenvalues& eigenvalues,
                          const ModalFilterOptions& options, double own, double step) {
  FilterCandidate found{.multiple = step / own, .time_step = step};
  double cells = 0, extra_cost = 0, filtered = 0;
  for (const auto& region : count(problem, eigenvalues, options, options.limit_of(step))) {
    cells += region.cells;
    extra_cost += region.extra_cost;
    filtered += region.filtered;
    if (region.cells > 0) found.softened = std::max(found.softened, region.softened_mass / region.mass);
    if (region.cells > 0 && region.slow == 0) found.within_reach = false;
  }
  found.filtered = static_cast<GlobalIndex>(filtered);
  found.gain = found.multiple / (1 + extra_cost / cells);
  return found;
}

}  // namespace

double relative_cost(const Material& material) {
  const auto name = std::visit([](const auto& model) { return model.name; }, material);
  const auto* const found = std::ranges::find(model_costs, name, &ModelCost::model);
  EVERT_ASSERT(found != model_costs.end(), std::string(name));
  return found->cost;
}

AutomaticStep choose_time_step(const FilterProblem& problem, const ModalFilterOptions& options) {
  AutomaticStep found{.own_step = own_step(problem, options),
                      .time_step = std::numeric_limits<double>::infinity()};
  std::vector<double> steps;
  const double fixed = options.fixed_time_step;
  if (fixed > 0) {
    if (fixed > found.own_step) steps.push_back(found.time_step = fixed);
  } else if (std::isfinite(found.own_step)) {
    for (const double multiple : multiples) steps.push_back(multiple * found.own_step);
  }
  if (steps.empty()) return found;
  CellEigenvalues eigenvalues{{}, eigenvalues_against_all_mass(problem)};
  for (const auto& cell : problem.cells) eigenvalues.own.push_back(own_eigenvalue(cell));
  double most = 0;
  for (const double step : steps) {
    const auto& looked_at =
        found.candidates.emplace_back(candidate(problem, eigenvalues, options, found.own_step, step));
    if (!looked_at.within_reach) break;  // nor is any larger step
    if (fixed > 0 || !looked_at.worthwhile(options) || looked_at.gain <= most) continue;
    most = looked_at.gain;
    found.time_step = step;
  }
  return found;
}

}  // namespace evert
