#pragma once
#include "evert/contact/contact_search.hpp"
#include "evert/contact/obstacle.hpp"
#include "evert/contact/push_out.hpp"
#include "evert/contact/standing_nodes.hpp"
#include "evert/contact/velocity_constraints.hpp"

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// Nodes against obstacles: projection to the surface, friction, and the velocity constraints that the
/// implicit solve then keeps.  paper A, section 9; docs/design/friction.md for how and why friction differs
/// from the paper, docs/design/contact.md for nodes inside several bodies and for fast ones
namespace evert {

/// How far a solve is from Coulomb's law: sums over the contacts of a rank [N s].
struct FrictionError {
  double excess = 0;   ///< of tangential impulses that are to change
  double allowed = 0;  ///< the coefficient times the normal impulses
};

/// What nodes got from an obstacle in a step; the obstacle gets the opposite.
struct ObstacleImpulse {
  Vec3d linear{};   ///< [N s]
  Vec3d angular{};  ///< about Obstacle::state().origin [N m s]
};

class Collisions {
 public:
  /// `masses` per owned node [kg]; kept by reference, as are the nodal arrays given to the calls below.
  Collisions(std::vector<std::unique_ptr<Obstacle>> obstacles, std::span<const double> masses);
  Collisions(const Collisions&) = delete;
  Collisions& operator=(const Collisions&) = delete;

  [[nodiscard]] bool any_obstacles() const { return !obstacles_.empty(); }
  [[nodiscard]] Obstacle* find(const std::string& name) const;
  [[nodiscard]] std::span<const std::unique_ptr<Obstacle>> obstacles() const { return obstacles_; }

  /// Before the solve that leads to x̃, at positions, velocities and forces at the beginning of the step: the
  /// nodes that stand on obstacles. They collide in the resolve() that follows. Nodes in `prescribed`
  /// (sorted) are left out.
  const StandingNodes& find_standing(std::span<const double> x, std::span<const double> v,
                                     std::span<const double> f, std::span<const NodeConstraint> prescribed,
                                     const StepInterval& step);

  /// Step 3 of PHYSICS 5, on the owned nodes (x y z each). `x` holds x̃ and gets xⁿ⁺¹, `v` holds vⁿ and gets
  /// ṽⁿ; `predicted` is the velocity ṽ that led to x̃. A colliding node is moved to the surface and keeps only
  /// the tangential motion that friction leaves; its velocity into the body becomes the body's. So is a node
  /// whose way led through a body. Nodes that `prescribed` (sorted) leaves no freedom pass through.
  void resolve(std::span<double> x, std::span<double> v, std::span<const double> predicted,
               std::span<const NodeConstraint> prescribed, const StepInterval& step);

  /// What the colliding nodes must keep in the solve, sorted by node: the normal velocity, and all of it
  /// where friction holds the node.
  [[nodiscard]] std::span<const NodeConstraint> constraints() const { return constraints_; }

  /// What slide() would change after a solve with constraints(), from its velocities `v` and `reaction` = A v
  /// − b per owned node [N s].
  [[nodiscard]] FrictionError friction_error(std::span<const double> v, std::span<const double> reaction);

  /// Friction after such a solve: nodes whose tangential reaction is more than Coulomb allows are let go,
  /// those that have turned round are held, and the impulses of friction on those that slide go to b: what
  /// changes of them is taken off `reaction`. constraints() then holds for a solve with that b.
  void slide(std::span<const double> v, std::span<double> reaction);

  /// The velocity of `obstacle` (its number) has changed since it was that of `before`, its place has not:
  /// from now on nodes on it are held to the new one.
  void follow(std::size_t obstacle, const RigidState& before);

  /// After the last solve: friction stops a node and never turns it round. Not on bodies with a mass, which
  /// have got their impulses by then.
  void stop_reversed(std::span<double> v);

  /// After that: adds to the impulses of the impacts what friction, stops and the last solve gave the nodes.
  /// Of the solve that is the part of `reaction` that `all` constraints exerted beyond those of `prescribed`.
  void share_impulses(std::span<const double> reaction, std::span<const NodeConstraint> prescribed,
                      std::span<const NodeConstraint> all);
  /// What `obstacle` (its number) has given to the nodes of this rank since resolve() began.
  [[nodiscard]] const ObstacleImpulse& impulse_of(std::size_t obstacle) const { return given_[obstacle]; }
  /// The same of all obstacles [N s].
  [[nodiscard]] Vec3d impulse() const;

  /// What a user should know since the last call, one sentence each; the same on every rank.
  [[nodiscard]] std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }

  /// Nodes that collided in the last resolve() on this rank.
  [[nodiscard]] LocalIndex contacts() const { return static_cast<LocalIndex>(contacts_.size()); }

 private:
  /// A node inside one or several bodies. Friction acts against its motion relative to the mean of their
  /// velocities, weighted with their coefficients.
  struct Contact {
    LocalIndex node = 0;
    std::size_t first_touch = 0, touches = 0;  // touches_[first_touch, first_touch + touches)
    bool pinched = false;                      // there is no room between the bodies
    Vec3d position{};                          // on the surface [m]
    Mat3d tangent{};                           // P, off the normals of all bodies
    Vec3d surface_velocity{};                  // the mean, at the end of the step [m/s]
    bool yields = false;                       // one of the bodies has a mass and gives way
    bool sticks = false;                       // friction holds it
    bool stopped = false;                      // again, after it has slid in this step
    Vec3d sliding{};                           // unit direction, where slide() found it sliding
    Vec3d friction{};                          // impulse that slide() put on it [N s]
    Vec3d impulse{};                           // of impacts and stops [N s]
  };

  [[nodiscard]] Box3 box_of(LocalIndex begin, LocalIndex end, std::span<const double> x,
                            std::span<const double> predicted, double dt) const;
  void resolve_node(LocalIndex node, std::span<double> x, std::span<double> v,
                    std::span<const double> predicted, std::span<const std::size_t> near, double dt);
  PushOut leave(Contact& contact, const Way& way, std::span<const std::size_t> near);
  void face_each_other(std::span<Touch> touches) const;
  void constrain(const Contact& contact, Vec3d v);
  Contact after_solve(Contact contact, const Vec3d& velocity, const Vec3d& reaction);
  void share_out(auto&& impulse);
  void warn_of_turns(double end);

  [[nodiscard]] std::span<const Touch> touches_of(const Contact& contact) const {
    return std::span(touches_).subspan(contact.first_touch, contact.touches);
  }
  [[nodiscard]] const Obstacle& body(const Touch& touch) const { return *obstacles_[touch.obstacle]; }
  [[nodiscard]] double friction(const Touch& touch) const { return body(touch).friction(); }
  [[nodiscard]] Vec3d mean_velocity(std::span<const Touch> touches, auto&& velocity) const;
  double most_friction(const Contact& contact, const Vec3d& impulse);

  std::vector<std::unique_ptr<Obstacle>> obstacles_;
  ContactSearch search_{obstacles_};
  StandingNodes standing_;
  std::span<const double> masses_;
  std::vector<Contact> contacts_;            // by node
  std::vector<Touch> touches_;               // by contact
  std::vector<NodeConstraint> constraints_;  // parallel to contacts_
  std::vector<ObstacleImpulse> given_;       // parallel to obstacles_
  std::vector<std::string> notes_;
  std::vector<bool> warned_;  // parallel to obstacles_
  // Of the node that is looked at:
  std::vector<Bound> bounds_;
  std::vector<double> shares_;
};

}  // namespace evert
