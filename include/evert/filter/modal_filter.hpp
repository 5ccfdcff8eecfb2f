#pragma once
#include "evert/filter/automatic_step.hpp"
#include "evert/filter/compliant_block.hpp"
#include "evert/filter/modal_filter_options.hpp"
#include "evert/filter/selection.hpp"
#include "evert/filter/shape_constraints.hpp"
#include "evert/filter/stiff_modes.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace evert {

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
  /// would be left. An automatic step is chosen here, and anew for every change of a material.
  ModalFilter(const DistributedMesh& mesh, ElasticForces& elastic, const ModalFilterOptions& options);

  /// Collective. Of a body that has been cut: `mesh` and `elastic` are new, and cells away from the change
  /// keep the filters that they have in `before`.
  ModalFilter(const ModalFilter& before, const DistributedMesh& mesh, ElasticForces& elastic,
              const TopologyChange& change);

  /// Collective. After ElasticForces::set_properties of `region`: filters its cells and those next to them
  /// anew.
  /// Throws UserError on all ranks when nothing of the new stiffness would be left.
  void material_changed(std::int32_t region);

  /// Collective. Filters anew what has flown noticeably since it was last looked at, in the shape that it has
  /// now, and what is next to it. Returns true where blocks were made anew: then forces are to be updated.
  bool follow_flow();

  /// As asked for.
  [[nodiscard]] const ModalFilterOptions& options() const { return options_; }
  /// The step that the filter is for [s]; infinity where an automatic one does not pay and nothing is
  /// filtered.
  [[nodiscard]] double time_step() const { return automatic_ ? automatic_->time_step : options_.time_step; }
  /// How an automatic step was chosen.
  [[nodiscard]] const std::optional<AutomaticStep>& automatic() const { return automatic_; }
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
  /// Collective. Takes all filters off, chooses the step of a body without any, and filters it for that.
  void choose();
  /// Collective.
  [[nodiscard]] bool filtered_on_any_rank() const;
  /// Collective. Selects anew, and brings the blocks up to date, which are as the clamps `in_force` say.
  /// Returns true where some were made anew, on any rank.
  bool update(const FilterProblem& problem, const ChangedNodes& changed, const CellClamps& in_force);
  /// Collective. Compliant blocks of the same cells are reshaped only.
  bool make_blocks(const FilterProblem& problem, const CellClamps& in_force);
  /// The cells of an entry that have a clamp, and a block of them. `first`: its first cell in the problem.
  [[nodiscard]] SeparateCells filtered_part(const FilterProblem& problem, std::size_t entry,
                                            std::size_t first);
  void reshape(const FilterProblem& problem, std::size_t entry, std::size_t first);

  const DistributedMesh& mesh_;
  ElasticForces& elastic_;
  ModalFilterOptions options_;
  std::optional<AutomaticStep> automatic_;
  CellClamps clamps_;
  std::vector<CompliantBlock*> compliant_;  // per entry, of `elastic_`; null where it has none
  std::vector<StiffCell> stiff_cells_;
  std::vector<ShapeConstraint> shape_constraints_;
  std::uint64_t revision_ = 0;
  LocalIndex looked_at_ = 0;
};

}  // namespace evert
