#pragma once
#include "evert/forces/node_matrix.hpp"
#include "evert/integrators/damping_operator.hpp"

namespace evert {

/// The operator of DampingOperator with its entries: for preconditioners that need them (gamg, hypre, icc,
/// bjacobi). One assembly costs tens of products, so it is made only on request (`-damping_mat_type
/// baij|sbaij|aij`).
class AssembledDamping {
 public:
  /// Collective. `type` is "baij", "sbaij" or "aij". Preallocates from the cells and attaches the rigid-body
  /// modes as near null space.
  AssembledDamping(const DampingOperator& damping, const char* type);

  /// Collective. Fills in the entries for the operator's present C, s and constraints.
  void assemble();
  [[nodiscard]] Mat mat() const { return matrix_.mat(); }

 private:
  void share_projectors();
  [[nodiscard]] double projector(LocalIndex node, std::size_t i, std::size_t j) const;
  void project_cell(const CellNodes& nodes);
  void add_strains();
  void add_lumped_masses();
  void add_consistent_masses();

  const DampingOperator& damping_;
  std::vector<NodeField> projectors_;  // the three columns of P per local node
  std::vector<double> cell_;           // scratch: one cell's matrix, row-major
  NodeMatrix matrix_;
};

}  // namespace evert
