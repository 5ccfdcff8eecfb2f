#include "evert/contact/rigid_body.hpp"

#include <algorithm>

namespace evert {

RigidBody::RigidBody(const MassProperties& mass, const RigidState& start)
    : mass_(mass), inverse_inertia_(inverse(mass.inertia)) {
  const auto center = start.to_world(mass.center);
  const auto spin = transpose_times(start.rotation, start.angular_velocity);
  begin_ = {center, quaternion_of(start.rotation), start.velocity_at(center),
            start.rotation * (mass.inertia * spin)};
  end_ = begin_;
}

RigidState RigidBody::at(double t) const { return frame_of(t < begin_time_ + dt_ / 2 ? begin_ : end_); }

RigidState RigidBody::frame_of(const State& state) const {
  RigidState frame{rotation_matrix(state.rotation), {}, {}, turn_of(state.rotation, state.angular_momentum)};
  const auto arm = frame.rotation * mass_.center;
  frame.origin = state.center - arm;
  frame.velocity = state.velocity - cross(frame.angular_velocity, arm);
  return frame;
}

Vec3d RigidBody::turn_of(const Quaternion& rotation, const Vec3d& angular_momentum) const {
  const auto r = rotation_matrix(rotation);
  return r * (inverse_inertia_ * transpose_times(r, angular_momentum));
}

void RigidBody::begin_step(double time, double dt, const Vec3d& gravity) {
  begin_ = end_;
  begin_time_ = time;
  dt_ = dt;
  end_.velocity = begin_.velocity + dt * gravity;
  end_.center =
      begin_.center + dt * begin_.velocity + (dt * dt / 2) * (gravity + (1 / mass_.mass) * nodal_force_);
  // The implicit midpoint rule: reversible, so that the energy of a free rotation does not drift either.
  const auto middle_momentum = begin_.angular_momentum + (dt / 2) * nodal_torque_;
  constexpr int most_iterations = 20;
  auto turn = turn_of(begin_.rotation, middle_momentum);
  for (int i = 0; i < most_iterations; ++i) {
    const auto before = turn;
    turn = turn_of(quaternion_by((dt / 2) * turn) * begin_.rotation, middle_momentum);
    if (norm(turn - before) <= 1e-15 * norm(turn)) break;
  }
  end_.rotation = normalized(quaternion_by(dt * turn) * begin_.rotation);
}

void RigidBody::add_impulse(const Vec3d& impulse, const Vec3d& place) {
  end_.velocity += (1 / mass_.mass) * impulse;
  end_.angular_momentum += cross(place - end_.center, impulse);
}

void RigidBody::place_by_mean_velocity() {
  const auto turn =
      turn_of(begin_.rotation, begin_.angular_momentum + dt_ * nodal_torque_) + angular_velocity();
  end_.center =
      begin_.center + (dt_ / 2) * (begin_.velocity + end_.velocity + (dt_ / mass_.mass) * nodal_force_);
  end_.rotation = normalized(quaternion_by((dt_ / 2) * turn) * begin_.rotation);
}

void RigidBody::push(const Vec3d& impulse, const Vec3d& place) {
  const auto turn = turn_of(end_.rotation, cross(place - end_.center, impulse));
  end_.center += (1 / mass_.mass) * impulse;
  end_.rotation = normalized(quaternion_by(turn) * end_.rotation);
}

void RigidBody::expect_nodes() {
  without_nodes_ = end_;
  set_nodal_impulse({dt_ * nodal_force_, dt_ * nodal_torque_});
}

void RigidBody::set_nodal_impulse(const CentralImpulse& impulse) {
  end_.velocity = without_nodes_.velocity + (1 / mass_.mass) * impulse.linear;
  end_.angular_momentum = without_nodes_.angular_momentum + impulse.angular;
  nodal_force_ = (1 / dt_) * impulse.linear;
  nodal_torque_ = (1 / dt_) * impulse.angular;
}

double RigidBody::product(const CentralImpulse& a, const CentralImpulse& b) const {
  return dot(a.linear, b.linear) / mass_.mass + dot(a.angular, turn_of(end_.rotation, b.angular));
}

double RigidBody::kinetic_energy() const {
  return (mass_.mass * dot(end_.velocity, end_.velocity) + dot(angular_velocity(), end_.angular_momentum)) /
         2;
}

Mat3d RigidBody::mobility(const Vec3d& place) const {
  const auto arm = place - end_.center;
  Mat3d result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto unit = identity<double>().column[k];
    result.column[k] = (1 / mass_.mass) * unit + cross(turn_of(end_.rotation, cross(arm, unit)), arm);
  }
  return result;
}

std::array<double, RigidBody::state_size> RigidBody::save() const {
  std::array<double, state_size> saved{};
  auto out = saved.begin();
  *out++ = end_.rotation.w;
  for (const auto* v : {&end_.rotation.v, &end_.center, &end_.velocity, &end_.angular_momentum, &nodal_force_,
                        &nodal_torque_})
    out = std::copy(v->components.begin(), v->components.end(), out);
  return saved;
}

void RigidBody::restore(std::span<const double, state_size> saved, double time) {
  auto in = saved.begin();
  end_.rotation.w = *in++;
  for (auto* v : {&end_.rotation.v, &end_.center, &end_.velocity, &end_.angular_momentum, &nodal_force_,
                  &nodal_torque_}) {
    std::copy(in, in + 3, v->components.begin());
    in += 3;
  }
  begin_ = end_;
  begin_time_ = time;
  dt_ = 0;
}

}  // namespace evert
