#pragma once
#include "evert/integrators/damping_solver.hpp"
#include "evert/integrators/rigid_coupling.hpp"
#include "evert/integrators/step_report.hpp"
#include "evert/integrators/system.hpp"

#include <optional>
#include <span>
#include <vector>

namespace evert {

/// What holds nodes in a step of which the velocities are solved for with obstacles in the way: the obstacles
/// that nodes collide with, and prescribed motion. Obstacles that are rigid bodies with a mass move along.
/// docs/design/friction.md, docs/design/rigid-bodies.md
class HeldNodes {
 public:
  explicit HeldNodes(const System& system);

  /// Whether there are such nodes on any rank.
  struct Kinds {
    bool colliding = false;
    bool prescribed = false;
    [[nodiscard]] bool any() const { return colliding || prescribed; }
  };
  /// What the solve for the velocity that leads to x̃ is to keep: prescribed motion in the middle of a step of
  /// `dt` [s], and nodes that stand on obstacles. Valid until the next call. The friction on those that slide
  /// goes to `right`, impulses.
  std::span<const NodeConstraint> hold_on_the_way(System& system, double dt, Vec right);

  /// Collective. Obstacles go to the end of the step, collisions turn x̃ into xⁿ⁺¹ and vⁿ into ṽⁿ; `predicted`
  /// is the velocity that led to x̃ in `dt` [s].
  Kinds collide(System& system, const NodeField& predicted, double dt);

  /// At the end of the step: prescribed velocities, and the normal ones of colliding nodes.
  [[nodiscard]] std::span<const NodeConstraint> constraints() const { return constraints_; }

  /// Collective. After a solve with constraints(), where they are any(): friction by Coulomb's law and the
  /// velocities of rigid bodies, for which the solve may be repeated, and the account of what was exerted.
  /// Returns the iterations that took.
  int rub(System& system, DampingSolver& solver);

  /// Collective. At the end of every step: bodies get what nodes got, with the opposite sign; the account of
  /// what obstacles gave, and what `report` says of them.
  void finish(System& system, StepReport& report);

 private:
  int couple(System& system, DampingSolver& solver);
  static void take_out_residual(System& system, std::span<const NodeConstraint> all,
                                std::span<const double> reaction);

  std::optional<RigidCoupling> coupling_;       // where a rigid body has a mass
  std::span<const NodeConstraint> prescribed_;  // at the end of the step; system.prescribed owns them
  std::vector<NodeConstraint> constraints_;     // those and the normals of colliding nodes
};

/// Of a `reaction` per owned node (DampingSolver::reaction), what `constraints` exerted of it [N s], on this
/// rank.
[[nodiscard]] Vec3d exerted(std::span<const NodeConstraint> constraints, std::span<const double> reaction);

/// What mass-proportional damping takes off the momentum in a time `dt` [s] at velocities `v` (x y z per
/// owned node).
void account_for_mass_damping(System& system, std::span<const double> v, double dt);

/// What gravity adds to it; that of rigid bodies is with what obstacles give.
void account_for_gravity(System& system, double dt);

/// What each obstacle gave in a step of `dt` [s], to nodes and to bodies, and what came from those that have
/// no momentum of their own; and the weight of bodies.
void account_for_obstacles(System& system, double dt);

}  // namespace evert
