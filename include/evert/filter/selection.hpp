#pragma once
#include "evert/filter/element_modes.hpp"
#include "evert/filter/filtered_block.hpp"
#include "evert/forces/elastic_forces.hpp"

#include <vector>

/// Which tetrahedra are filtered, and against which masses.  PHYSICS 9
namespace evert {

/// All are rigorous: λmax(M⁻¹K') ≤ limit.
enum class FilterSelection {
  paper,       ///< λ(K_e, M_e) > limit, M_e the cell's own masses, ρV/4 a node.  paper B, eq. (9)
  spare_mass,  ///< what slow cells do not need of the mass of their nodes goes to the fast ones: never more
               ///< cells than `paper`, and from one ring of neighbours alone
  adaptive,    ///< cells that are too fast against all the mass of their nodes, then those that carry the
               ///< energy of what is still too fast: the fewest, from the whole body
};
[[nodiscard]] constexpr const char* name_of(FilterSelection selection) {
  return selection == FilterSelection::paper        ? "paper"
         : selection == FilterSelection::spare_mass ? "spare_mass"
                                                    : "adaptive";
}

/// A tetrahedron that may have to be filtered.
struct FilterCell {
  std::array<LocalIndex, 4> nodes{};  ///< local numbers
  TetShape shape{};    ///< as it has flown, if it can: then its gradients are turned, by any rotation
  double density = 0;  ///< [kg/m³]
  Lame lame{};

  [[nodiscard]] TetMasses own_masses() const {
    const double mass = density * shape.volume / 4;
    return {mass, mass, mass, mass};
  }
};

/// Everything that selections look at, of one rank.
struct FilterProblem {
  const DistributedMesh& mesh;
  const ElasticForces& elastic;
  std::vector<FilterCell> cells;  ///< of the rank, entry after entry of DistributedMesh::cells
  std::vector<double> masses;     ///< of all local nodes, ghosts included [kg]
};

/// Collective. All cells must be tet4.
[[nodiscard]] FilterProblem filter_problem(const DistributedMesh& mesh, const ElasticForces& elastic);

/// How each of FilterProblem::cells is filtered; limit 0: not at all.
using CellClamps = std::vector<CellClamp>;

/// True per local node, on all ranks that have it, where a cell changes, comes or goes: the rest of the mesh
/// keeps its filters.
using ChangedNodes = std::vector<bool>;

/// Collective. Brings `clamps` up to date with λmax(M⁻¹K') ≤ `limit` [1/s²] and returns how many cells of
/// this rank have been looked at: those at changed nodes and, to know their neighbours, the next ring; with
/// `adaptive` every cell.
LocalIndex select(FilterSelection selection, const FilterProblem& problem, double limit,
                  const ChangedNodes& changed, CellClamps& clamps);

/// The least that any filter has to soften, per cell: λ(K_e, M̃_e) with all the mass of its nodes [1/s²],
/// which λmax(M⁻¹K) is never below.  paper B, eq. (8)
[[nodiscard]] std::vector<double> eigenvalues_against_all_mass(const FilterProblem& problem);

}  // namespace evert
