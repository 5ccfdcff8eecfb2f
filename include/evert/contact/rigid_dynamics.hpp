#pragma once
#include "evert/contact/obstacle.hpp"
#include "evert/contact/rigid_contacts.hpp"

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace evert {

/// The obstacles that are rigid bodies with a mass. Every rank has all of them and moves them alike; what
/// nodes give them must come summed over the ranks.  docs/design/rigid-bodies.md
class RigidDynamics {
 public:
  /// `obstacles` must outlive this.
  explicit RigidDynamics(std::span<const std::unique_ptr<Obstacle>> obstacles);

  [[nodiscard]] bool empty() const { return bodies_.empty(); }
  /// Which of the obstacles are such bodies, by number.
  [[nodiscard]] std::span<const std::size_t> bodies() const { return bodies_; }
  [[nodiscard]] const RigidBody& body(std::size_t obstacle) const { return *obstacles_[obstacle]->body(); }

  /// Takes all obstacles to the end of `step`: the bodies by `gravity` and by what they touch of each other
  /// and of the rest.
  void advance(const StepInterval& step, const Vec3d& gravity);
  /// What nodes give `obstacle`, a body, in this step, in the place of what was said of that before; first,
  /// it is what they gave in the step before. Its velocities change, its place does not.
  void set_nodal_impulse(std::size_t obstacle, const CentralImpulse& impulse);
  /// An impulse with an angular part about the origin of the frame of `obstacle`, about its centre instead.
  [[nodiscard]] CentralImpulse central(std::size_t obstacle, const Vec3d& linear, const Vec3d& angular) const;

  /// What `obstacle` gave to the bodies in the last advance(), the angular part about the origin of its frame
  /// [N s, N m s].
  [[nodiscard]] const std::pair<Vec3d, Vec3d>& impulse_of(std::size_t obstacle) const {
    return contacts_.given(obstacle);
  }

  /// Names and values of all that a checkpoint keeps, in an order of their own.
  [[nodiscard]] std::vector<std::pair<std::string, double>> state() const;
  /// Replaces it by what state() gave, at `time` [s].
  void restore(std::span<const std::pair<std::string, double>> kept, double time);

 private:
  std::span<const std::unique_ptr<Obstacle>> obstacles_;
  std::vector<std::size_t> bodies_;
  RigidContacts contacts_;
  StepInterval step_;
};

}  // namespace evert
