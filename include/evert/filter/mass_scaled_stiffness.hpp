#pragma once
#include "evert/forces/node_matrix.hpp"

#include <functional>

namespace evert {

/// A = M^−½ K M^−½ of a whole body as an assembled PETSc matrix of 3×3 blocks: its eigenvalues are those of
/// M⁻¹K, the squares of the frequencies [1/s²]. M are the lumped masses; no node is held, and holding some
/// can only lower the largest eigenvalue.
class MassScaledStiffness {
 public:
  /// Collective.
  MassScaledStiffness(const DistributedMesh& mesh, const ElasticForces& elastic);

  /// Collective. K = −∂f/∂x at `x` [N/m], whose ghosts are brought up to date; not projected, and so not
  /// positive semidefinite where a state is not stable.
  void assemble(NodeField& x);

  /// Collective. K is what `add_cells` adds to the matrix that it is given, once for every cell of the rank:
  /// for elements that are changed.
  void assemble(const std::function<void(NodeMatrix&)>& add_cells);

  [[nodiscard]] Mat mat() const { return matrix_.mat(); }
  [[nodiscard]] const DistributedMesh& mesh() const { return mesh_; }

 private:
  const DistributedMesh& mesh_;
  const ElasticForces& elastic_;
  NodeMatrix matrix_;
  VecHandle scale_;  // M^−½, three a node
};

}  // namespace evert
