#pragma once
#include "evert/contact/rigid_body.hpp"
#include "evert/shapes/implicit_surface.hpp"

#include <limits>
#include <memory>
#include <string>

/// Rigid bodies that nodes collide with: a shape, and how it moves.  paper A, section 9; PHYSICS 8
namespace evert {

/// A time step.
struct StepInterval {
  double end = 0;  ///< [s]
  double dt = 0;   ///< [s]
};

/// A rigid body in the place that it has at the end of a step. Every rank holds all obstacles.
class Obstacle {
 public:
  Obstacle(std::string name, double friction, std::unique_ptr<ImplicitSurface> surface,
           std::unique_ptr<RigidMotion> motion);
  /// One that the nodes and other obstacles move.
  Obstacle(std::string name, double friction, std::unique_ptr<ImplicitSurface> surface,
           std::unique_ptr<RigidBody> body);

  /// Takes the body to the end of `step`. What follows speaks of there.
  void move_to(const StepInterval& step);

  /// Later than `time` [s] it is not there: its bounds are empty, and nothing collides with it.
  void remove_after(double time) { until_ = time; }
  [[nodiscard]] bool is_there() const { return step_.end <= until_; }

  /// Contains the body at both ends of the step.
  [[nodiscard]] const Box3& bounds() const { return bounds_; }
  /// As ImplicitSurface, in the world.
  [[nodiscard]] double signed_distance(const Vec3d& x) const {
    return surface_->signed_distance(now_.to_body(x));
  }
  [[nodiscard]] Vec3d normal(const Vec3d& x) const {
    return now_.rotation * surface_->normal(now_.to_body(x));
  }
  /// Of the body's material at `x` [m/s].
  [[nodiscard]] Vec3d velocity(const Vec3d& x) const { return now_.velocity_at(x); }
  /// The same on average over the step: the way of the material that is at `x` now, over dt. What sticks to a
  /// turning body goes this way, and not along the tangent.
  [[nodiscard]] Vec3d mean_velocity(const Vec3d& x) const {
    return (1 / step_.dt) * (x - before_.to_world(now_.to_body(x)));
  }
  [[nodiscard]] const RigidState& state() const { return now_; }
  /// At the beginning of the step.
  [[nodiscard]] const RigidState& before() const { return before_; }
  [[nodiscard]] const ImplicitSurface& surface() const { return *surface_; }

  /// Null where the motion is prescribed.
  [[nodiscard]] RigidBody* body() const { return body_; }

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Coulomb coefficient, ≥ 0.
  [[nodiscard]] double friction() const { return friction_; }
  void set_friction(double friction) { friction_ = friction; }

 private:
  std::string name_;
  double friction_;
  std::unique_ptr<ImplicitSurface> surface_;
  std::unique_ptr<RigidMotion> motion_;
  RigidBody* body_ = nullptr;  // motion_, where it is one
  double until_ = std::numeric_limits<double>::infinity();
  StepInterval step_;
  RigidState before_, now_;
  Box3 bounds_;
};

}  // namespace evert
