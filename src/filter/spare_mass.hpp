#pragma once
#include "evert/filter/selection.hpp"

#include "nodal_sums.hpp"
#include <span>

namespace evert {

/// λ(K_e, M_e) of the cell alone, with its own masses: eq. (9) of paper B [1/s²].
[[nodiscard]] double own_eigenvalue(const FilterCell& cell);

/// How cells share masses for one limit. A cell with λ(K_e, M_e) ≤ limit gets along with λ/limit of its own
/// masses. What is left at a node is spare, and goes to the others there in proportion to their stiffness.
/// The shares sum to the masses, and so no eigenvalue of the body exceeds the largest of any cell against its
/// shares.
class SpareMass {
 public:
  /// Collective. `own` eigenvalues are needed of the cells to be clamped and of all that share a node with
  /// them. Refers to both.
  SpareMass(const FilterProblem& problem, std::span<const double> own, double limit);

  /// Of cell `c`; limit 0 where it is slow enough.
  [[nodiscard]] CellClamp clamp(std::size_t c) const;

 private:
  const FilterProblem& problem_;
  std::span<const double> own_;
  double limit_;
  NodalSums sums_;  // mass that slow cells need; stiffness of fast ones
};

}  // namespace evert
