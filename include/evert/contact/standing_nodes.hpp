#pragma once
#include "evert/contact/contact_search.hpp"
#include "evert/contact/push_out.hpp"
#include "evert/contact/velocity_constraints.hpp"

#include <span>
#include <vector>

namespace evert {

/// Nodal values at the beginning of a step, x y z per owned node but for the masses.
struct NodalState {
  std::span<const double> masses;  ///< [kg]
  std::span<const double> x, v;    ///< [m], [m/s]
  std::span<const double> f;       ///< elastic forces and weight [N]
};

/// Nodes that stand on half-spaces: on the surface, not leaving it, and pressed on by the forces. The solve
/// that leads to the end of the step has to know of them: it would else let them fall in, and pull what is
/// near along.  docs/design/friction.md
class StandingNodes {
 public:
  /// Obstacles are kept by reference, and are to be moved to the end of the step before what follows.
  StandingNodes(std::span<const std::unique_ptr<Obstacle>> obstacles, std::size_t nodes);

  /// At the beginning of a step of `dt` [s]. Nodes in `prescribed` (sorted) are not looked at.
  void find(const NodalState& state, std::span<const NodeConstraint> prescribed, double dt);
  void clear();

  /// They go along with their bodies, at least in the directions of the normals; sorted by node.
  [[nodiscard]] std::span<const NodeConstraint> constraints() const { return constraints_; }
  /// Impulses of friction in half of the step on those that slide, parallel to constraints() [N s].
  [[nodiscard]] std::span<const Vec3d> friction() const { return friction_; }

  /// Adds the bodies that a node, at `place` at the end of the step, stands on to those it is in, from
  /// `first` on in the list. Once after each find(), nodes in rising order.
  void add_touches(LocalIndex node, const Vec3d& place, std::size_t first, std::vector<Touch>& touches);

 private:
  struct Foot {
    LocalIndex node;
    std::size_t obstacle;
  };
  void look_at(LocalIndex node, const NodalState& state, double dt);
  bool stands_on(const Obstacle& obstacle, const Vec3d& x, const Vec3d& v, const Vec3d& impulse);

  std::span<const std::unique_ptr<Obstacle>> obstacles_;
  std::vector<std::size_t> planes_;  // numbers of the half-spaces that move as the scene says
  std::vector<Foot> feet_;           // by node
  std::vector<NodeConstraint> constraints_;
  std::vector<Vec3d> friction_;
  std::size_t asked_ = 0;  // feet before this one have been asked for
  // Of the node that is looked at:
  std::vector<Bound> normals_;
  std::vector<double> shares_;
};

}  // namespace evert
