#pragma once
#include "evert/contact/obstacle.hpp"
#include "evert/contact/velocity_constraints.hpp"

#include <memory>
#include <span>
#include <vector>

/// Nodes against obstacles: projection to the surface, friction, and the velocity constraints that the
/// implicit solve then keeps.  paper A, section 9; docs/design/friction.md for how and why friction differs
/// from the paper
namespace evert {

/// How far a solve is from Coulomb's law: sums over the contacts of a rank [N s].
struct FrictionError {
  double excess = 0;   ///< of tangential impulses that are to change
  double allowed = 0;  ///< the coefficient times the normal impulses
};

class Collisions {
 public:
  /// `masses` per owned node [kg]; kept by reference, as are the nodal arrays given to the calls below.
  Collisions(std::vector<std::unique_ptr<Obstacle>> obstacles, std::span<const double> masses);

  [[nodiscard]] bool any_obstacles() const { return !obstacles_.empty(); }
  [[nodiscard]] Obstacle* find(const std::string& name) const;
  [[nodiscard]] std::span<const std::unique_ptr<Obstacle>> obstacles() const { return obstacles_; }

  /// Step 3 of PHYSICS 5, on the owned nodes (x y z each). `x` holds x̃ and gets xⁿ⁺¹, `v` holds vⁿ and gets
  /// ṽⁿ; `predicted` is the velocity ṽ that led to x̃. A colliding node is moved to the surface and keeps only
  /// the tangential motion that friction leaves; its velocity into the body becomes the body's. Nodes that
  /// `prescribed` (sorted) leaves no freedom pass through.
  void resolve(std::span<double> x, std::span<double> v, std::span<const double> predicted,
               std::span<const NodeConstraint> prescribed, const StepInterval& step);

  /// What the colliding nodes must keep in the solve, sorted by node: the normal velocity, and all of it
  /// where friction holds the node.
  [[nodiscard]] std::span<const NodeConstraint> constraints() const { return constraints_; }

  /// What slide() would change after a solve with constraints(), from its velocities `v` and `reaction` = A v
  /// − b per owned node [N s].
  [[nodiscard]] FrictionError friction_error(std::span<const double> v,
                                             std::span<const double> reaction) const;

  /// Friction after such a solve: nodes whose tangential reaction is more than Coulomb allows are let go,
  /// those that have turned round are held, and the impulses of friction on those that slide go to b: what
  /// changes of them is taken off `reaction`. constraints() then holds for a solve with that b.
  void slide(std::span<const double> v, std::span<double> reaction);

  /// After the last solve: friction stops a node and never turns it round.
  void stop_reversed(std::span<double> v);

  /// Nodes that collided in the last resolve() on this rank.
  [[nodiscard]] LocalIndex contacts() const { return static_cast<LocalIndex>(constraints_.size()); }
  /// Sum of the impulses that slide() has put on b since resolve() [N s]; this rank's share.
  [[nodiscard]] Vec3d friction() const;
  /// Impulse of impacts (resolve) and stops (stop_reversed) in the last step [N s]; this rank's share.
  [[nodiscard]] Vec3d impulse() const { return impulse_; }

 private:
  /// One node inside one obstacle.
  struct Contact {
    LocalIndex node;
    const Obstacle* obstacle;
    Vec3d normal;
    Vec3d body_velocity;
    bool sticks;           // friction holds it
    bool stopped = false;  // again, after it has slid in this step
    Vec3d sliding{};       // unit direction, where slide() found it sliding
    Vec3d friction{};      // impulse that slide() put on it [N s]
  };
  void resolve_node(LocalIndex node, Vec3d& x, Vec3d& v, Vec3d predicted, const StepInterval& step);
  void constrain(std::span<const Contact> of_node, Vec3d v);
  static Contact after_solve(Contact contact, const Vec3d& velocity, const Vec3d& reaction);

  std::vector<std::unique_ptr<Obstacle>> obstacles_;
  std::span<const double> masses_;
  std::vector<Contact> contacts_;            // by node, then in the order of the obstacles
  std::vector<NodeConstraint> constraints_;  // by node
  Vec3d impulse_{};
};

}  // namespace evert
