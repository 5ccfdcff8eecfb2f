#pragma once
#include "evert/contact/velocity_constraints.hpp"
#include "evert/core/petsc.hpp"
#include "evert/forces/elastic_forces.hpp"
#include "evert/integrators/implicit_strains.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace evert {

/// The operator of the implicit velocity solves, A = M + s P C P, as a matrix-free PETSc matrix (MATSHELL).
/// C is the damping operator at the positions of the last force update, s = Δt/2, P the projector off the
/// constrained velocities; P (M + s C) P + M (I − P) is the same thing where M is lumped.  PHYSICS 5
///
/// With implicit strains C stands for C + θΔt²/s K_s.
///
/// Where M is consistent, A = P (M + s C) P + D (I − P) with D the diagonal of M.
class DampingOperator {
 public:
  /// Collective. `strains` may be null.
  DampingOperator(const DistributedMesh& mesh, const ElasticForces& elastic,
                  ImplicitStrains* strains = nullptr);
  DampingOperator(const DampingOperator&) = delete;
  DampingOperator& operator=(const DampingOperator&) = delete;

  /// Sets s [s] and the constraints, which must outlive the products.
  void set(double factor, std::span<const NodeConstraint> constraints);
  /// C has changed: the diagonal is out of date.
  void invalidate() { diagonal_valid_ = false; }

  /// Collective. y = A x, Vecs of 3 values per owned node.
  void multiply(Vec x, Vec y) const;
  // Collective. On owned nodes, constraints left aside; the last two of consistent masses:
  /// `out` += factor · C v
  void add_damping(Vec v, Vec out, double factor) const;
  /// `out` += M v
  void add_momentum(Vec v, Vec out) const;
  /// `out` += M v + factor · C v
  void add_momentum_and_damping(Vec v, Vec out, double factor) const;
  /// Collective. The inverses of A's owned 3×3 diagonal blocks, 9 numbers by columns each.
  [[nodiscard]] std::span<const double> inverse_diagonal() const;
  /// Collective. `out` = A's diagonal.
  void diagonal(Vec out) const;

  [[nodiscard]] double factor() const { return factor_; }
  [[nodiscard]] std::span<const NodeConstraint> constraints() const { return constraints_; }
  [[nodiscard]] const ElasticForces& elastic() const { return elastic_; }
  [[nodiscard]] const ImplicitStrains* strains() const { return strains_; }
  [[nodiscard]] const DistributedMesh& mesh() const { return mesh_; }

  /// The MATSHELL; PCs that need no entries (pbjacobi, jacobi, none) work on it.
  [[nodiscard]] Mat mat() const { return mat_.get(); }

 private:
  template <class Product>
  void add_product(Vec v, Vec out, Product&& product) const;
  void update_diagonals() const;
  template <class Work>
  void for_each_diagonal_block(Work&& work) const;

  const DistributedMesh& mesh_;
  const ElasticForces& elastic_;
  ImplicitStrains* strains_;
  std::span<const double> masses_;  // the diagonal of M
  double factor_ = 0;
  std::span<const NodeConstraint> constraints_;
  mutable NodeField in_, out_;
  mutable bool diagonal_valid_ = false;
  mutable NodeField normal_, shear_;  // diagonal blocks of C: xx yy zz, yz xz xy
  struct OfStrains {
    NodeField normal, shear;
    std::uint64_t changes;  // of θΔt² K_s that they are of
  };
  mutable std::optional<OfStrains> of_strains_;   // the same of θΔt² K_s, where there is any
  mutable std::vector<double> inverse_diagonal_;  // of A
  MatHandle mat_;
};

}  // namespace evert
