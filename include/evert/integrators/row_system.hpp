#pragma once
#include "evert/contact/velocity_constraints.hpp"
#include "evert/forces/elastic_forces.hpp"
#include "evert/integrators/spanning_rows.hpp"
#include "evert/math/sparse_ldl.hpp"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace evert {

/// Rows j of a matrix J that each take up to four nodes, Σ_a j_a · v_a, and the solves with
///
///   S = diag(compliance) + J W Jᵀ,  W = P M⁻¹ P
///
/// P the projector off what holds nodes. Rows that share nodes with none of another rank are solved by a
/// sparse factorisation of each rank's own, without communication; those that do by PETSc over all ranks.
/// Patterns are found once.  PHYSICS 9
class RowSystem {
 public:
  /// Local nodes of a row; −1 in the place of those that it has less than four of.
  using Nodes = std::array<LocalIndex, 4>;
  using Coefficients = std::array<Vec3d, 4>;

  /// Collective. `rows` of this rank, none of them of the same node twice; masses must be lumped.
  RowSystem(const DistributedMesh& mesh, const ElasticForces& elastic, std::vector<Nodes> rows);

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// To be set before factor(): those without a node stay zero.
  [[nodiscard]] std::span<Coefficients> coefficients() { return coefficients_; }
  [[nodiscard]] std::span<const Coefficients> coefficients() const { return coefficients_; }
  [[nodiscard]] std::span<const Nodes> nodes() const { return nodes_; }
  [[nodiscard]] std::span<double> compliances() { return compliances_; }
  [[nodiscard]] std::span<const double> compliances() const { return compliances_; }

  /// After a change of coefficients or compliances.
  void changed() { stale_ = true; }
  /// Collective. Of rows, compliances and held nodes (sorted) as they are; nothing is done where all is as it
  /// was. Where they are not finite, neither are the solutions.
  void factor(std::span<const NodeConstraint> held);
  /// Collective. `b` ← S⁻¹ b, one value a row.
  void solve(std::span<double> b);

  /// Collective. `values` ← J v, whose ghosts are brought up to date where rows have any.
  void apply(NodeField& v, std::span<double> values) const;
  /// Collective. `v` −= W Jᵀ `values` on owned nodes, W with these nodes held.
  void take_off(std::span<const double> values, std::span<const NodeConstraint> held, NodeField& v) const;
  /// Collective. `v` += Jᵀ `values` on owned nodes.
  void add_transposed(std::span<const double> values, NodeField& v) const;

  /// Collective. Adds the symmetric 3×3 diagonal blocks of Jᵀ diag(1/compliance) J at owned nodes: xx yy zz
  /// to `normal`, yz xz xy to `shear`; their ghosts are scratch.
  void add_diagonal(NodeField& normal, NodeField& shear) const;

  /// Whether rows of any rank have nodes that the rank does not own.
  [[nodiscard]] bool has_ghosts() const { return has_ghosts_; }
  /// J W of the last factor().
  [[nodiscard]] std::span<const Coefficients> moved() const { return moved_; }

  /// Rows of all ranks that are solved by PETSc.
  [[nodiscard]] GlobalIndex spanning_rows() const { return spanning_count_; }
  /// Rows of this rank that are solved on it.
  [[nodiscard]] std::size_t rows_inside() const { return inside_.size(); }

 private:
  /// What rows i ≥ j have of an entry of S at a node that they share.
  struct Term {
    std::int32_t entry;
    std::int32_t row, column;
    std::int8_t row_slot, column_slot;
  };
  void find_spanning_rows();
  void find_pattern();
  [[nodiscard]] bool any_held(std::span<const NodeConstraint> held) const;
  void set_mobilities(std::span<const NodeConstraint> held);
  void share_mobilities(std::span<const NodeConstraint> held);
  void fill_inside();
  void spread(std::span<const double> values) const;
  template <class Visit>
  void for_each_touched(Visit&& visit) const;

  const DistributedMesh& mesh_;
  const Halo& halo_;
  std::span<const double> masses_;
  std::vector<Nodes> nodes_;
  std::vector<Coefficients> coefficients_, moved_;  // J, J W
  std::vector<double> compliances_;
  std::vector<LocalIndex> used_;                    // local nodes that rows have, ascending
  std::vector<Mat3d> mobilities_;                   // W at used_
  std::vector<std::array<std::int32_t, 4>> slots_;  // of a row's nodes in used_
  bool has_ghosts_ = false;                         // some row of some rank
  std::vector<NodeField> columns_;                  // of W on their way to ghosts; empty without
  mutable NodeField scratch_;

  std::vector<std::int32_t> inside_;  // rows that are solved on this rank
  std::vector<Term> terms_;
  std::vector<double> entries_;  // of S among them
  std::vector<std::int32_t> diagonal_;
  std::vector<double> right_;
  bool definite_ = false, stale_ = true, held_ = false;
  std::optional<SparseLdl> ldl_;

  GlobalIndex spanning_count_ = 0;
  std::unique_ptr<SpanningRows> spanning_;
};

}  // namespace evert
