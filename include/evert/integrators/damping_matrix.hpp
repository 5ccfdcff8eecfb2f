#pragma once
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
  [[nodiscard]] Mat mat() const { return mat_.get(); }

 private:
  void preallocate(const char* type);
  void attach_rigid_body_modes();
  void add_cell(Mat mat);
  [[nodiscard]] GlobalIndex global_number(PetscInt local) const;
  void share_projectors();
  void project_cell(std::span<const LocalIndex> nodes);
  template <class Work>
  void for_each_cell(Work&& work);

  const DampingOperator& damping_;
  bool upper_only_;                    // sbaij stores the upper triangle
  std::vector<NodeField> projectors_;  // the three columns of P per local node
  std::vector<PetscInt> rows_;         // scratch: one cell's nodes
  std::vector<double> cell_;           // scratch: one cell's matrix, row-major
  MatHandle mat_;
};

}  // namespace evert
