#include "evert/filter/selection.hpp"

#include "adaptive.hpp"
#include "nodal_sums.hpp"
#include "spare_mass.hpp"
#include <algorithm>

namespace evert {
namespace {

bool touches(const FilterCell& cell, const ChangedNodes& nodes) {
  return std::ranges::any_of(cell.nodes,
                             [&](LocalIndex node) { return nodes[static_cast<std::size_t>(node)]; });
}

/// Collective. The nodes of all cells that touch `nodes`, of any rank.
ChangedNodes with_neighbours(const FilterProblem& problem, const ChangedNodes& nodes) {
  NodalSums flags(problem);
  for (const auto& cell : problem.cells)
    if (touches(cell, nodes))
      for (const LocalIndex node : cell.nodes) flags.at(node, 0) = 1;
  flags.share();
  ChangedNodes wider(nodes.size());
  for (std::size_t i = 0; i < wider.size(); ++i) wider[i] = flags.at(static_cast<LocalIndex>(i), 0) > 0;
  return wider;
}

LocalIndex select_paper(const FilterProblem& problem, double limit, const ChangedNodes& changed,
                        CellClamps& clamps) {
  LocalIndex looked_at = 0;
  for (std::size_t c = 0; c < problem.cells.size(); ++c) {
    const auto& cell = problem.cells[c];
    if (!touches(cell, changed)) continue;
    ++looked_at;
    const auto masses = cell.own_masses();
    clamps[c] = own_eigenvalue(cell) > limit ? CellClamp{masses, limit} : CellClamp{};
  }
  return looked_at;
}

LocalIndex select_spare_mass(const FilterProblem& problem, double limit, const ChangedNodes& changed,
                             CellClamps& clamps) {
  const ChangedNodes needed = with_neighbours(problem, changed);
  std::vector<double> own(problem.cells.size());  // where it is needed
  LocalIndex looked_at = 0;
  for (std::size_t c = 0; c < problem.cells.size(); ++c) {
    if (!touches(problem.cells[c], needed)) continue;
    ++looked_at;
    own[c] = own_eigenvalue(problem.cells[c]);
  }
  const SpareMass spare(problem, own, limit);
  for (std::size_t c = 0; c < problem.cells.size(); ++c)
    if (touches(problem.cells[c], changed)) clamps[c] = spare.clamp(c);
  return looked_at;
}

/// The cells of an entry that can flow.
void use_flown_shapes(const ElasticForces& elastic, std::size_t entry, std::span<FilterCell> cells) {
  std::vector<Vec3d> gradients(4 * cells.size());
  elastic.flown_gradients(entry, gradients);
  for (std::size_t c = 0; c < cells.size(); ++c)
    std::copy_n(gradients.begin() + static_cast<std::ptrdiff_t>(4 * c), 4, cells[c].shape.gradients.begin());
}

}  // namespace

FilterProblem filter_problem(const DistributedMesh& mesh, const ElasticForces& elastic) {
  FilterProblem problem{mesh, elastic, {}, {}};
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    const auto& entry = mesh.cells[e];
    const std::size_t first_cell = problem.cells.size();
    const auto& properties = elastic.properties(entry.region);
    const Lame lame = std::visit([](const auto& model) { return model.lame; }, properties.material);
    for (std::size_t first = 0; first < entry.nodes.size(); first += 4) {
      const auto nodes = std::span(entry.nodes).subspan(first, 4);
      FilterCell cell{{}, tet_shape(nodes, mesh.rest_positions), properties.density, lame};
      std::copy(nodes.begin(), nodes.end(), cell.nodes.begin());
      problem.cells.push_back(cell);
    }
    if (properties.plasticity) use_flown_shapes(elastic, e, std::span(problem.cells).subspan(first_cell));
  }
  NodeField masses(mesh);
  for (std::size_t i = 0; i < masses.owned().size(); ++i) masses.owned()[i] = elastic.masses()[i / 3];
  masses.touched();
  elastic.halo().begin_update(masses);
  elastic.halo().end_update(masses);
  for (std::size_t i = 0; i < masses.local().size(); i += 3) problem.masses.push_back(masses.local()[i]);
  return problem;
}

std::vector<double> eigenvalues_against_all_mass(const FilterProblem& problem) {
  std::vector<double> all;
  all.reserve(problem.cells.size());
  for (const auto& cell : problem.cells)
    all.push_back(element_modes(cell.shape, masses_of_nodes(problem, cell), cell.lame).largest());
  return all;
}

LocalIndex select(FilterSelection selection, const FilterProblem& problem, double limit,
                  const ChangedNodes& changed, CellClamps& clamps) {
  if (selection == FilterSelection::paper) return select_paper(problem, limit, changed, clamps);
  if (selection == FilterSelection::spare_mass) return select_spare_mass(problem, limit, changed, clamps);
  std::vector<bool> at_changed_nodes;
  for (const auto& cell : problem.cells) at_changed_nodes.push_back(touches(cell, changed));
  return select_adaptive(problem, limit, at_changed_nodes, clamps);
}

}  // namespace evert
