#pragma once
#include "evert/filter/modal_filter.hpp"
#include "evert/integrators/row_system.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace evert {

/// Keeps the lengths and heights of a filter with `paper` constraints, by a fast projection of every step's
/// positions, and the velocities with them.  paper B, section 5; PHYSICS 9
///
/// Positions go along W Jᵀ λ with (J W Jᵀ + 1e-8 of its diagonal) λ = C until all are met to 1e-6 of their
/// lengths, or for as many sweeps as the filter's options say. Constraints that depend on each other are
/// thereby met by the least of multipliers; those of which a scene holds or moves all nodes have no row in J.
class ShapeProjection {
 public:
  /// Collective. Of the shape constraints of `filter`, which it keeps up with.
  ShapeProjection(const DistributedMesh& mesh, const ElasticForces& elastic, const ModalFilter& filter);
  /// Collective. Of these of this rank.
  ShapeProjection(const DistributedMesh& mesh, const ElasticForces& elastic,
                  std::vector<ShapeConstraint> constraints, FilterProjection form);

  /// Collective. At the beginning of a step, with what is `prescribed` in it (sorted): with `shake` J is that
  /// at `x`, whose ghosts are up to date.
  void begin(const NodeField& x, std::span<const NodeConstraint> prescribed);
  /// Collective. Changes `x` so that the constraints are met, and `v` by what that is in `dt` [s]; `held`
  /// nodes stay in the directions in which they are held. Returns the iterations that took. Where they cannot
  /// be met throws on all ranks, UserError where held nodes contradict them, else SimulationError.
  int project(NodeField& x, NodeField& v, std::span<const NodeConstraint> held, double dt);

  [[nodiscard]] const RowSystem& rows() const { return *rows_; }

 private:
  [[nodiscard]] bool follow(std::span<const NodeConstraint> prescribed);
  void rebuild();
  void set_rows(const NodeField& x);
  double take_violations(NodeField& x);
  [[nodiscard]] bool is_held(std::size_t k) const;
  [[noreturn]] void give_up(double left) const;

  const DistributedMesh& mesh_;
  const ElasticForces& elastic_;
  const ModalFilter* filter_ = nullptr;  // null: the constraints stay
  FilterProjection form_;
  int sweeps_ = 0;                                  // 0: until all are met
  std::vector<ShapeConstraint> all_, constraints_;  // as given; those of rows_ first
  std::vector<LocalIndex> fixed_;                   // owned nodes that are prescribed in all directions
  std::optional<RowSystem> rows_;
  std::vector<double> values_, inverse_masses_;  // one a constraint; per local node [1/kg]
  NodeField before_;
  std::uint64_t revision_ = 0;
};

}  // namespace evert
