#pragma once
#include "evert/filter/filtered_block.hpp"
#include "evert/filter/selection.hpp"

#include <array>
#include <span>
#include <vector>

/// What a filter takes off the stiffness of elements, mode by mode: K − K' = Σ_k w_k j_k j_kᵀ, for steps that
/// take it implicitly instead of leaving it out.  PHYSICS 9; docs/design/modal-filter.md
namespace evert {

/// A strain in which an element is too fast: j_a = s g_a at rest, g_a the shape gradients.
struct StiffMode {
  Mat3d strain;   ///< s, symmetric [√Pa]
  double weight;  ///< w = V (1 − limit/λ) [m³]
};

/// A clamped element with at least one such mode.
struct StiffCell {
  std::array<LocalIndex, 4> nodes{};  ///< local numbers
  std::array<Vec3d, 4> gradients{};   ///< at rest [1/m]
  std::int32_t region = 0;
  std::vector<StiffMode> modes;
};

/// The cells of the problem that `clamps` limit, in its order.
[[nodiscard]] std::vector<StiffCell> stiff_cells(const FilterProblem& problem,
                                                 std::span<const CellClamp> clamps);

/// One vector a node.
using TetRow = std::array<Vec3d, 4>;

/// How the stiffness of an element compares with that at rest turned by R, at the stretches of the moment:
/// K ⪯ growth K(R) + spin 4 V Γ₂ M*, Γ₂ the middle eigenvalue of Σ g_a g_aᵀ/m*_a. docs/design/modal-filter.md
struct StiffnessNow {
  double growth = 1;  ///< [-] ≥ 1
  double spin = 0;    ///< [Pa] ≥ 0
};
[[nodiscard]] StiffnessNow stiffness_now(const Material& material, const Vec3d& stretches);

/// The rows j_k of the cell's modes at positions `x` (x y z per local node): those at rest turned by R = U Vᵀ
/// and made free of torque, so that no turning of the element moves them. Allocates nothing. Returns growth.
double stiff_rows(const StiffCell& cell, const Material& material, std::span<const double> x,
                  std::span<TetRow> rows);

}  // namespace evert
