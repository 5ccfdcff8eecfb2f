#pragma once
#include "evert/contact/velocity_constraints.hpp"
#include "evert/forces/node_matrix.hpp"

#include <span>
#include <vector>

namespace evert {

/// K(x) + σ M in the directions that are free, as a PETSc matrix: K = −∂f/∂x of the elastic forces, M the
/// lumped masses. Rows and columns of held components are zero but for their diagonal, which stays that of K
/// + σ M.
class StiffnessMatrix {
 public:
  /// Collective. `type` is "baij", "sbaij" or "aij".
  StiffnessMatrix(const DistributedMesh& mesh, const ElasticForces& elastic, const char* type);

  /// Collective. Takes on the components that `constraints` hold, which must be whole axes, and the ways [m]
  /// that they prescribe.
  void hold(std::span<const NodeConstraint> constraints);
  /// Collective. Fills in the entries at `x`, whose ghosts are brought up to date. `inertia` is σ [1/s²].
  void assemble(NodeField& x, TangentForm form, double inertia);
  /// Collective. The same, and `pull` = K w on free components, w the ways of the held ones.
  void assemble(NodeField& x, TangentForm form, double inertia, NodeField& pull);

  [[nodiscard]] Mat mat() const { return matrix_.mat(); }

 private:
  void fill(NodeField& x, TangentForm form, double inertia, NodeField* pull);
  void add_pull(const CellNodes& nodes, std::span<const double> matrix, std::span<double> pull) const;
  void mask(const CellNodes& nodes, std::span<double> matrix) const;

  const DistributedMesh& mesh_;
  const ElasticForces& elastic_;
  NodeMatrix matrix_;
  NodeField free_;            // 1 where a component is free, 0 where it is held
  NodeField ways_;            // of held components
  std::vector<double> cell_;  // scratch: one cell's matrix
};

}  // namespace evert
