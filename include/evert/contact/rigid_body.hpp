#pragma once
#include "evert/contact/mass_properties.hpp"
#include "evert/contact/rigid_motion.hpp"
#include "evert/math/quaternion.hpp"

#include <array>
#include <span>

namespace evert {

/// An impulse on a rigid body [N s], with the angular one about its centre of mass [N m s].
struct CentralImpulse {
  Vec3d linear{}, angular{};
};

/// A rigid body that moves by the forces on it: in each step first on its own (begin_step), then by the
/// impulses of other bodies, then by those of nodes. Its angular momentum is the state, and its rotation a
/// unit quaternion, so that what is not acted on keeps its angular momentum to the last bit.
/// docs/design/rigid-bodies.md
class RigidBody final : public RigidMotion {
 public:
  /// `start` is the state of the frame that the mass properties are given in.
  RigidBody(const MassProperties& mass, const RigidState& start);

  /// The state at the begin or at the end of the present step, whichever is nearer to `t`.
  [[nodiscard]] RigidState at(double t) const override;

  /// Goes on by `dt` from `time`, free but for `gravity` and, for the place, for the force of nodes in the
  /// step before.
  void begin_step(double time, double dt, const Vec3d& gravity);
  /// An impulse at a place of the world changes the velocities at the end of the step, not the place.
  void add_impulse(const Vec3d& impulse, const Vec3d& place);
  /// Goes to where the mean of the velocities at the begin and at the end of the step leads.
  void place_by_mean_velocity();
  /// Moves the body as an impulse in unit time would, in place and not in velocity.
  void push(const Vec3d& impulse, const Vec3d& place);
  /// No more impulses of other bodies in this step. Expects of nodes what they exerted in the step before.
  void expect_nodes();
  /// The velocities become those that this impulse of nodes makes of what expect_nodes() found.
  void set_nodal_impulse(const CentralImpulse& impulse);
  [[nodiscard]] CentralImpulse nodal_impulse() const { return {dt_ * nodal_force_, dt_ * nodal_torque_}; }
  /// aᵀ M⁻¹ b, twice the energy that an impulse a = b gives the body at rest.
  [[nodiscard]] double product(const CentralImpulse& a, const CentralImpulse& b) const;

  [[nodiscard]] const MassProperties& mass() const { return mass_; }
  // At the end of the step:
  [[nodiscard]] const Vec3d& center() const { return end_.center; }
  [[nodiscard]] const Vec3d& velocity() const { return end_.velocity; }  ///< of that centre of mass [m/s]
  [[nodiscard]] const Vec3d& angular_momentum() const { return end_.angular_momentum; }  ///< about it
  [[nodiscard]] Vec3d angular_velocity() const { return turn_of(end_.rotation, end_.angular_momentum); }
  [[nodiscard]] Vec3d velocity_at(const Vec3d& place) const {
    return end_.velocity + cross(angular_velocity(), place - end_.center);
  }
  [[nodiscard]] double kinetic_energy() const;
  /// The change of velocity_at(place) that a unit of impulse makes there: symmetric, positive definite.
  [[nodiscard]] Mat3d mobility(const Vec3d& place) const;

  /// All that a checkpoint keeps, between steps.
  static constexpr std::size_t state_size = 19;
  [[nodiscard]] std::array<double, state_size> save() const;
  void restore(std::span<const double, state_size> saved, double time);

 private:
  struct State {
    Vec3d center{};            // of mass [m]
    Quaternion rotation{};     // of the frame
    Vec3d velocity{};          // of the centre [m/s]
    Vec3d angular_momentum{};  // about the centre, in the world [kg m²/s]
  };
  /// ω for an angular momentum.
  [[nodiscard]] Vec3d turn_of(const Quaternion& rotation, const Vec3d& angular_momentum) const;
  [[nodiscard]] RigidState frame_of(const State& state) const;

  MassProperties mass_;
  Mat3d inverse_inertia_;
  State begin_, end_;
  State without_nodes_;                   // end_ before the impulse of nodes
  double begin_time_ = 0, dt_ = 0;        // [s]
  Vec3d nodal_force_{}, nodal_torque_{};  // of the step before, then of this one [N], [N m]
};

}  // namespace evert
