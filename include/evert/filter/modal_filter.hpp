#pragma once
#include "evert/filter/filter_constraints.hpp"
#include "evert/filter/selection.hpp"
#include "evert/filter/shape_constraints.hpp"
#include "evert/filter/stiff_modes.hpp"

#include <cstdint>
#include <vector>

namespace evert {

struct ModalFilterOptions {
  double time_step = 0;  ///< [s] that steps may have
  double safety =
      1.25;  ///< [-] ≥ 1: how much larger a step the filtered body takes at rest; strain stiffens it
  FilterSelection selection = FilterSelection::spare_mass;
  FilterConstraints constraints = FilterConstraints::none;  ///< compliant: the integrator must take part
  FilterProjection projection = FilterProjection::shake;    ///< of `paper`
  double stability_constant = 2;  ///< c of the integrator: ωΔt ≤ c is stable without damping

  /// (c/Δt)² that no squared frequency of the filtered body exceeds at rest [1/s²]; implicit damping only
  /// raises c.
  [[nodiscard]] double limit() const {
    const double frequency = stability_constant / (safety * time_step);
    return frequency * frequency;
  }
  /// What K_s is added to M with, in a step of `dt` [s], for its part of the stiffness to be as far below
  /// what is stable as the limit of the rest: θ Δt² with θ = (safety/c)² [s²].
  [[nodiscard]] double implicit_factor(double dt) const {
    const double time = safety * dt / stability_constant;
    return time * time;
  }
};

/// What a change of topology leaves of the cells of a rank; cells keep their rank.
struct TopologyChange {
  std::vector<LocalIndex>
      origins;           ///< per cell now, in the order of FilterProblem::cells: its number before, −1: new
  ChangedNodes changed;  ///< nodes now, also those of cells that went
};

/// Keeps the fast vibrations of bad elements below what a step allows: the cells that need it leave the
/// blocks of their regions for filtered ones, or for compliant ones, of which the step takes implicitly what
/// the filter would take off.  paper B, section 4; PHYSICS 9
class ModalFilter {
 public:
  /// Collective. Filters the cells of `elastic`. Throws UserError on all ranks for consistent masses, for
  /// cells other than tet4, for models with fibres, and for a step at which nothing of a region's stiffness
  /// would be left.
  ModalFilter(const DistributedMesh& mesh, ElasticForces& elastic, const ModalFilterOptions& options);

  /// Collective. Of a body that has been cut: `mesh` and `elastic` are new, and cells away from the change
  /// keep the filters that they have in `before`.
  ModalFilter(const ModalFilter& before, const DistributedMesh& mesh, ElasticForces& elastic,
              const TopologyChange& change);

  /// Collective. After ElasticForces::set_properties of `region`: filters its cells and those next to them
  /// anew.
  /// Throws UserError on all ranks when nothing of the new stiffness would be left.
  void material_changed(std::int32_t region);

  [[nodiscard]] const ModalFilterOptions& options() const { return options_; }
  /// Of this rank, entry after entry of DistributedMesh::cells.
  [[nodiscard]] const CellClamps& clamps() const { return clamps_; }
  [[nodiscard]] LocalIndex filtered_cells() const;
  /// With `compliant`, what the step has to take implicitly, of this rank; else none. They change with
  /// revision().
  [[nodiscard]] const std::vector<StiffCell>& stiff_cells() const { return stiff_cells_; }
  /// With `paper`, the lengths that are kept, of this rank; else none. They change with revision().
  [[nodiscard]] const std::vector<ShapeConstraint>& shape_constraints() const { return shape_constraints_; }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// Cells of this rank whose vibrations the last change has made it look at.
  [[nodiscard]] LocalIndex looked_at() const { return looked_at_; }

 private:
  /// Collective. Selects anew, and makes the blocks of the entries that are not as the clamps `in_force` say.
  void update(const FilterProblem& problem, const ChangedNodes& changed, const CellClamps& in_force);
  [[nodiscard]] SeparateCells filtered_part(std::size_t entry, std::span<const CellClamp> clamps) const;

  const DistributedMesh& mesh_;
  ElasticForces& elastic_;
  ModalFilterOptions options_;
  CellClamps clamps_;
  std::vector<StiffCell> stiff_cells_;
  std::vector<ShapeConstraint> shape_constraints_;
  std::uint64_t revision_ = 0;
  LocalIndex looked_at_ = 0;
};

}  // namespace evert
