#include "evert/filter/modal_filter.hpp"

#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/core/log.hpp"
#include "evert/filter/compliant_block.hpp"

#include "nodal_sums.hpp"
#include "spare_mass.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace evert {
namespace {

bool is_clamped(const CellClamp& clamp) { return clamp.limit > 0; }

/// Collective. Throws UserError unless masses are lumped and every cell is a tet4 of an isotropic model.
void require_what_can_be_filtered(const DistributedMesh& mesh, const ElasticForces& elastic) {
  if (elastic.consistent_mass() != nullptr)
    throw UserError("filter: elements are filtered against masses of nodes: these must be lumped");
  std::vector<GlobalIndex> cells;
  for (const auto& entry : mesh.cells) cells.push_back(entry.size());
  MPI_Allreduce(MPI_IN_PLACE, cells.data(), static_cast<int>(cells.size()), MPI_INT64_T, MPI_SUM, mesh.comm);
  for (std::size_t e = 0; e < cells.size(); ++e) {
    if (cells[e] == 0) continue;
    const auto& entry = mesh.cells[e];
    const auto& region = mesh.regions[static_cast<std::size_t>(entry.region)];
    if (entry.type != CellType::tet4)
      throw UserError("filter: '" + region + "' has elements " + std::string(name_of(entry.type)) +
                      "; only linear tetrahedra, tet4, can be filtered");
    if (has_fibres(elastic.properties(entry.region).material))
      throw UserError("filter: '" + region + "' has fibres; only isotropic materials can be filtered");
  }
}

/// Collective. Throws UserError where all six vibrations of every element of a region are too fast even
/// against all the mass of its nodes: then, whatever the selection, the filter replaces all of its stiffness.
/// Where a single one is slow enough, softening the others reaches any step.
void require_stiffness_to_be_left(const FilterProblem& problem, const ModalFilterOptions& options,
                                  double time_step) {
  const auto& mesh = problem.mesh;
  std::vector<double> slowest(mesh.regions.size(), std::numeric_limits<double>::infinity());
  auto next = problem.cells.begin();
  for (const auto& entry : mesh.cells)
    for (LocalIndex c = 0; c < entry.size(); ++c, ++next) {
      auto& of_region = slowest[static_cast<std::size_t>(entry.region)];
      of_region = std::min(
          of_region, element_modes(next->shape, masses_of_nodes(problem, *next), next->lame).smallest());
    }
  MPI_Allreduce(MPI_IN_PLACE, slowest.data(), static_cast<int>(slowest.size()), MPI_DOUBLE, MPI_MIN,
                mesh.comm);
  for (std::size_t r = 0; r < slowest.size(); ++r)
    if (slowest[r] > options.limit_of(time_step) && std::isfinite(slowest[r]))
      throw UserError(
          formatted("filter.time_step: no filter can reach %g s with a safety of %g: every element of '%s' "
                    "would have to be softened in all directions, and nothing of its material be left; "
                    "allowed is less than %.3g s",
                    time_step, options.safety, mesh.regions[r].c_str(),
                    options.stability_constant / std::sqrt(slowest[r]) / options.safety));
}

/// Collective. The nodes, of any rank, of cells that have gone some way, which begins anew.
ChangedNodes nodes_of_flown(const FilterProblem& problem, ElasticForces& elastic) {
  NodalSums flown(problem);
  auto next = problem.cells.begin();
  for (std::size_t e = 0; e < problem.mesh.cells.size(); ++e) {
    const auto count = static_cast<std::size_t>(problem.mesh.cells[e].size());
    std::vector<double> way(count);
    elastic.way_of_flow(e, way);
    for (std::size_t c = 0; c < count; ++c, ++next) {
      if (!(way[c] > 0)) continue;
      for (const LocalIndex node : next->nodes) flown.at(node, 0) = 1;
      way[c] = 0;
    }
    elastic.set_way_of_flow(e, way);
  }
  flown.share();
  ChangedNodes nodes(problem.masses.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = flown.at(static_cast<LocalIndex>(i), 0) > 0;
  return nodes;
}

/// How far log F_p of a cell may go before it is looked at again: until its largest eigenvalue can have come
/// a tenth of the limit nearer to that (materials/plasticity.hpp, stiffness_growth); that of a filtered one,
/// a tenth of itself.
double way_until_looked_at(const FilterCell& cell, const CellClamp& clamp, double limit) {
  const double largest = is_clamped(clamp) ? limit : own_eigenvalue(cell);
  const double bulk = std::max(cell.lame.lambda, 0.0) / (2 * cell.lame.mu);
  return std::log1p(0.1 * limit / largest) / (2 + std::max(bulk, 1.0));
}

void bound_ways(const FilterProblem& problem, ElasticForces& elastic, const CellClamps& clamps,
                double limit) {
  std::size_t c = 0;
  for (std::size_t e = 0; e < problem.mesh.cells.size(); ++e) {
    std::vector<double> most(static_cast<std::size_t>(problem.mesh.cells[e].size()));
    for (double& of_cell : most) {
      of_cell = way_until_looked_at(problem.cells[c], clamps[c], limit);
      ++c;
    }
    elastic.bound_way_of_flow(e, most);
  }
}

/// Throws UserError for constraints of which the cells would have no strain to yield by.
void require_strains_that_yield(const ElasticForces& elastic, FilterConstraints constraints) {
  if (elastic.may_flow() && constraints != FilterConstraints::compliant)
    throw UserError(std::string("filter.constraints: '") + name_of(constraints) +
                    "' does not go with plasticity, which must be 'compliant': else filtered elements have "
                    "less stress than they yield at");
}

}  // namespace

ModalFilter::ModalFilter(const DistributedMesh& mesh, ElasticForces& elastic,
                         const ModalFilterOptions& options)
    : mesh_(mesh), elastic_(elastic), options_(options) {
  require_what_can_be_filtered(mesh, elastic);
  require_strains_that_yield(elastic, options.constraints);
  if (options_.automatic()) {
    choose();
    return;
  }
  const auto problem = filter_problem(mesh, elastic);
  require_stiffness_to_be_left(problem, options, options.time_step);
  clamps_.resize(problem.cells.size());
  update(problem, ChangedNodes(problem.masses.size(), true), CellClamps(clamps_));
}

ModalFilter::ModalFilter(const ModalFilter& before, const DistributedMesh& mesh, ElasticForces& elastic,
                         const TopologyChange& change)
    : mesh_(mesh), elastic_(elastic), options_(before.options_), automatic_(before.automatic_) {
  require_what_can_be_filtered(mesh, elastic);
  const auto problem = filter_problem(mesh, elastic);
  for (const LocalIndex origin : change.origins)
    clamps_.push_back(origin < 0 ? CellClamp{} : before.clamps_[static_cast<std::size_t>(origin)]);
  update(problem, change.changed, CellClamps(clamps_.size()));
}

void ModalFilter::choose() {
  std::vector<SeparateCells> none;
  for (std::size_t e = 0; e < mesh_.cells.size(); ++e) none.push_back({.entry = e});
  if (filtered_on_any_rank()) elastic_.separate(std::move(none));
  const auto problem = filter_problem(mesh_, elastic_);
  clamps_.assign(problem.cells.size(), {});
  compliant_.assign(mesh_.cells.size(), nullptr);
  stiff_cells_.clear();
  shape_constraints_.clear();
  ++revision_;
  automatic_ = choose_time_step(problem, options_);
  if (!std::isfinite(time_step())) return;
  require_stiffness_to_be_left(problem, options_, time_step());
  update(problem, ChangedNodes(problem.masses.size(), true), CellClamps(clamps_));
}

bool ModalFilter::filtered_on_any_rank() const {
  int filtered = filtered_cells() > 0 ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &filtered, 1, MPI_INT, MPI_MAX, mesh_.comm);
  return filtered != 0;
}

void ModalFilter::material_changed(std::int32_t region) {
  if (options_.automatic()) return choose();
  const auto problem = filter_problem(mesh_, elastic_);
  require_stiffness_to_be_left(problem, options_, options_.time_step);
  NodalSums of_region(problem);
  for (const auto& entry : mesh_.cells)
    if (entry.region == region)
      for (const LocalIndex node : entry.nodes) of_region.at(node, 0) = 1;
  of_region.share();
  ChangedNodes changed(problem.masses.size());
  for (std::size_t i = 0; i < changed.size(); ++i)
    changed[i] = of_region.at(static_cast<LocalIndex>(i), 0) > 0;
  update(problem, changed, CellClamps(clamps_));
}

bool ModalFilter::update(const FilterProblem& problem, const ChangedNodes& changed,
                         const CellClamps& in_force) {
  if (!std::isfinite(time_step())) return false;  // of a body that was cut
  looked_at_ = select(options_.selection, problem, options_.limit_of(time_step()), changed, clamps_);
  const bool made = make_blocks(problem, in_force);
  if (elastic_.may_flow()) bound_ways(problem, elastic_, clamps_, options_.limit_of(time_step()));
  if (options_.constraints == FilterConstraints::compliant)
    stiff_cells_ = evert::stiff_cells(problem, clamps_);
  if (options_.constraints == FilterConstraints::paper)
    shape_constraints_ = evert::shape_constraints(problem, clamps_);
  ++revision_;
  return made;
}

bool ModalFilter::make_blocks(const FilterProblem& problem, const CellClamps& in_force) {
  compliant_.resize(mesh_.cells.size());
  std::vector<SeparateCells> separate;
  std::size_t first = 0;
  for (std::size_t e = 0; e < mesh_.cells.size(); ++e) {
    const auto count = static_cast<std::size_t>(mesh_.cells[e].size());
    const auto now = std::span<const CellClamp>(clamps_).subspan(first, count);
    const auto before = std::span(in_force).subspan(first, count);
    if (compliant_[e] != nullptr && std::ranges::equal(now, before, {}, is_clamped, is_clamped))
      reshape(problem, e, first);
    else if (!std::ranges::equal(now, before))
      separate.push_back(filtered_part(problem, e, first));
    first += count;
  }
  int some = separate.empty() ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &some, 1, MPI_INT, MPI_MAX, mesh_.comm);
  if (some != 0) elastic_.separate(std::move(separate));
  return some != 0;
}

bool ModalFilter::follow_flow() {
  if (!elastic_.may_flow() || !std::isfinite(time_step())) return false;
  int beyond = elastic_.flow_is_beyond_bounds() ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &beyond, 1, MPI_INT, MPI_MAX, mesh_.comm);
  if (beyond == 0) return false;
  const PhaseScope phase(Phase::filter);
  const auto problem = filter_problem(mesh_, elastic_);
  return update(problem, nodes_of_flown(problem, elastic_), CellClamps(clamps_));
}

void ModalFilter::reshape(const FilterProblem& problem, std::size_t entry, std::size_t first) {
  std::vector<TetShape> shapes;
  CellClamps clamps;
  for (std::size_t c = first; c < first + static_cast<std::size_t>(mesh_.cells[entry].size()); ++c) {
    if (!is_clamped(clamps_[c])) continue;
    shapes.push_back(problem.cells[c].shape);
    clamps.push_back(clamps_[c]);
  }
  compliant_[entry]->reshape(shapes, clamps);
}

SeparateCells ModalFilter::filtered_part(const FilterProblem& problem, std::size_t entry, std::size_t first) {
  const auto& all = mesh_.cells[entry];
  compliant_[entry] = nullptr;
  SeparateCells part{.entry = entry};
  std::vector<LocalIndex> nodes;
  std::vector<TetShape> shapes;
  CellClamps clamps;
  LocalIndex interior = 0;
  for (LocalIndex cell = 0; cell < all.size(); ++cell) {
    const std::size_t c = first + static_cast<std::size_t>(cell);
    if (!is_clamped(clamps_[c])) continue;
    part.cells.push_back(cell);
    clamps.push_back(clamps_[c]);
    const auto& of_cell = problem.cells[c];
    shapes.push_back(of_cell.shape);
    nodes.insert(nodes.end(), of_cell.nodes.begin(), of_cell.nodes.end());
    interior += cell < all.interior ? 1 : 0;
  }
  if (part.cells.empty()) return part;
  const auto& properties = elastic_.properties(all.region);
  const ElasticCells cells{.type = all.type,
                           .nodes = nodes,
                           .interior = interior,
                           .density = properties.density,
                           .plasticity = properties.plasticity};
  const auto& rest = mesh_.rest_positions;
  if (options_.constraints == FilterConstraints::compliant) {
    auto block = make_compliant_block(
        make_elastic_block(cells, rest, properties.material, properties.damping, properties.precision), cells,
        shapes, clamps);
    compliant_[entry] = block.get();
    part.block = std::move(block);
  } else {
    part.block = make_filtered_block(cells, rest, properties.material, properties.damping, clamps);
  }
  return part;
}

LocalIndex ModalFilter::filtered_cells() const {
  return static_cast<LocalIndex>(std::ranges::count_if(clamps_, is_clamped));
}

}  // namespace evert
