#pragma once
#include "evert/filter/modal_filter.hpp"
#include "evert/integrators/row_system.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace evert {

/// The stiffness that a compliant filter takes out of the explicit part of a step, K_s = Σ_k w_k j_k j_kᵀ, as
/// what it is for the changes of velocity in that step: masses, M + θΔt² K_s.  PHYSICS 9
///
/// J M⁻¹ Jᵀ + diag(1/(θΔt² w_k)) is factored once for the positions, the length and the held nodes of a step.
class ImplicitStrains {
 public:
  /// Collective. Of the stiff cells of `filter`, which it keeps up with.
  ImplicitStrains(const DistributedMesh& mesh, const ElasticForces& elastic, const ModalFilter& filter);

  /// Collective. K_s at `x`, whose ghosts are up to date, for a step of `dt` [s]; `state` counts the
  /// positions, and nothing is done where all is as it was.
  void prepare(const NodeField& x, double dt, std::uint64_t state);

  /// Collective. `change` = (M + P θΔt² K_s P)⁻¹ `momentum` with `held` nodes projected off by P; `momentum`
  /// must be in the free directions.
  void solve(Vec momentum, Vec change, std::span<const NodeConstraint> held);
  /// Collective. `out` += θΔt² K_s v on owned nodes; the ghosts of v are brought up to date.
  void add_product(NodeField& v, NodeField& out);
  /// Collective. `out` += factor θΔt² K_s v, Vecs of 3 values per owned node.
  void add_product(Vec v, Vec out, double factor);
  /// Collective. Adds the symmetric 3×3 diagonal blocks of θΔt² K_s at owned nodes: xx yy zz to `normal`, yz
  /// xz xy to `shear`, whose ghosts are scratch.
  void add_diagonal(NodeField& normal, NodeField& shear) const { rows_->add_diagonal(normal, shear); }

  /// The rows j_k and compliances 1/(θΔt² w_k).
  [[nodiscard]] const RowSystem& rows() const { return *rows_; }
  /// Counts the changes of θΔt² K_s.
  [[nodiscard]] std::uint64_t changes() const { return changes_; }

 private:
  void rebuild();

  const DistributedMesh& mesh_;
  const ElasticForces& elastic_;
  const ModalFilter& filter_;
  std::optional<RowSystem> rows_;
  std::vector<double> values_;  // one a row
  NodeField change_, product_;
  std::uint64_t revision_ = 0, state_ = 0, changes_ = 0;
  double dt_ = 0;
};

}  // namespace evert
