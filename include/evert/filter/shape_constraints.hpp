#pragma once
#include "evert/filter/selection.hpp"
#include "evert/filter/stiff_modes.hpp"

#include <array>
#include <span>
#include <vector>

/// What paper B keeps of the shapes of softened elements: the lengths of edges and heights that are short.
/// paper B, section 5; PHYSICS 9
namespace evert {

/// An edge: its two nodes, −1, −1. A height: its apex, then the corners of the face below it.
struct ShapeConstraint {
  std::array<LocalIndex, 4> nodes{-1, -1, -1, -1};  ///< local numbers
  double rest = 0;                                  ///< [m] length; of a height positive at rest

  [[nodiscard]] bool is_edge() const { return nodes[2] < 0; }
};

/// How far a constraint is from being met at positions `x` (x y z per local node), and the gradient of that:
/// (|d|² − l²)/2l of an edge, the signed height less that at rest. (Eq. (12), of its square, is met by the
/// mirror image, too, and has no gradient where the element is flat.) [m]
[[nodiscard]] double violation(const ShapeConstraint& constraint, std::span<const double> x,
                               TetRow& gradient);

/// Collective. Those of all cells that `clamps` limit, by their shape classes: of a needle the three short
/// edges, of a wedge the short one, of a cap the height, of others all six. An edge of several cells is there
/// once, on the lowest rank that has it.
[[nodiscard]] std::vector<ShapeConstraint> shape_constraints(const FilterProblem& problem,
                                                             std::span<const CellClamp> clamps);

}  // namespace evert
