#pragma once
#include "evert/integrators/system.hpp"

#include <functional>
#include <vector>

namespace evert {

/// Nodes and rigid bodies with mass in one step. A node on a body must have the velocity that the body has
/// after it got the impulses of all nodes on it: those impulses s solve s = −j(s), where j(s) is what the
/// nodes get when they are held to the velocity that s gives the bodies. j is affine for given contacts, so
/// that conjugate gradients solve it in few evaluations; each is a solve for the nodes. To take the velocity
/// before the impact instead makes bodies unstable that are lighter than what they touch, to which the
/// implicit damping belongs.  docs/design/rigid-bodies.md
class RigidCoupling {
 public:
  explicit RigidCoupling(const System& system);

  /// Solves once more for the nodes, now held to the present velocities of the bodies and not to those of
  /// `before` (per body), and leaves what they get to system.collisions.
  using Follow = std::function<void(std::span<const RigidState> before)>;

  /// Collective. Takes the bodies to the velocities that go with the impulses; system.collisions must hold
  /// those of the nodes as they are.
  void solve(System& system, const Follow& follow);
  /// Collective. The bodies get what nodes got in this step, with the opposite sign, to the last bit.
  void finish(System& system);

 private:
  using Impulse = std::vector<CentralImpulse>;  // per body
  void gather(const System& system, Impulse& sum);
  void set(System& system, const Impulse& impulse);
  [[nodiscard]] static double product(const System& system, const Impulse& a, const Impulse& b);

  Impulse on_bodies_, residual_, direction_, given_, trial_;
  std::vector<RigidState> before_;
  std::vector<double> numbers_;  // of a reduction
};

}  // namespace evert
