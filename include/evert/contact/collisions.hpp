#pragma once
#include <memory>
#include <span>
#include <vector>

#include "evert/contact/obstacle.hpp"
#include "evert/contact/velocity_constraints.hpp"

/// Nodes against obstacles: projection to the surface, friction, and the velocity constraints that the implicit
/// solve then keeps.  paper A, section 9; docs/design/friction.md for how and why friction differs from the paper
namespace evert {

/// The end of the step that is being made.
struct StepInterval {
  double end = 0;  ///< [s]
  double dt = 0;   ///< [s]
};

class Collisions {
 public:
  /// `masses` per owned node [kg]; kept by reference, as are the nodal arrays given to the calls below.
  Collisions(std::vector<std::unique_ptr<Obstacle>> obstacles, std::span<const double> masses);

  [[nodiscard]] bool any_obstacles() const { return !obstacles_.empty(); }
  [[nodiscard]] Obstacle* find(const std::string& name) const;
  [[nodiscard]] std::span<const std::unique_ptr<Obstacle>> obstacles() const { return obstacles_; }

  /// Step 3 of PHYSICS 5, on the owned nodes (x y z each). `x` holds x̃ and gets xⁿ⁺¹, `v` holds vⁿ and gets ṽⁿ;
  /// `predicted` is the velocity ṽ that led to x̃. A colliding node is moved to the surface and keeps only the
  /// tangential motion that friction leaves; its velocity into the body becomes the body's.
  /// Nodes that `prescribed` (sorted) leaves no freedom pass through.
  void resolve(std::span<double> x, std::span<double> v, std::span<const double> predicted,
               std::span<const NodeConstraint> prescribed, const StepInterval& step);

  /// The normal directions of the nodes that collided in the last resolve(), sorted by node.
  [[nodiscard]] std::span<const NodeConstraint> constraints() const { return constraints_; }

  /// Friction of the normal impulses that the constraints exerted in the solve: `reaction` = A v − b per owned node
  /// [N s]. Changes the tangential velocities, at most to the obstacle's.
  void apply_friction(std::span<double> v, std::span<const double> reaction);

  /// Nodes that collided in the last resolve() on this rank.
  [[nodiscard]] LocalIndex contacts() const { return static_cast<LocalIndex>(constraints_.size()); }
  /// Impulse that the obstacles gave to this rank's nodes in the last step, reactions of the solve excepted [N s].
  [[nodiscard]] Vec3d impulse() const { return impulse_; }

 private:
  /// One node inside one obstacle.
  struct Contact {
    LocalIndex node;
    const Obstacle* obstacle;
    Vec3d normal;
    Vec3d body_velocity;
  };
  void resolve_node(LocalIndex node, Vec3d& x, Vec3d& v, Vec3d predicted, const StepInterval& step);
  void constrain(std::size_t first_contact, const Vec3d& v);

  std::vector<std::unique_ptr<Obstacle>> obstacles_;
  std::span<const double> masses_;
  std::vector<Contact> contacts_;            // by node, then in the order of the obstacles
  std::vector<NodeConstraint> constraints_;  // by node
  Vec3d impulse_{};
};

}  // namespace evert
