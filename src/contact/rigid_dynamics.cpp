#include "evert/contact/rigid_dynamics.hpp"

#include <algorithm>

namespace evert {

RigidDynamics::RigidDynamics(std::span<const std::unique_ptr<Obstacle>> obstacles)
    : obstacles_(obstacles), contacts_(obstacles) {
  for (std::size_t o = 0; o < obstacles.size(); ++o)
    if (obstacles[o]->body() != nullptr) bodies_.push_back(o);
}

void RigidDynamics::advance(const StepInterval& step, const Vec3d& gravity) {
  step_ = step;
  for (const auto& obstacle : obstacles_) {
    if (auto* body = obstacle->body()) body->begin_step(step.end - step.dt, step.dt, gravity);
    obstacle->move_to(step);
  }
  contacts_.find();
  contacts_.stop();
  for (const auto number : bodies_)
    if (contacts_.touches(number)) obstacles_[number]->body()->place_by_mean_velocity();
  contacts_.separate();
  for (const auto number : bodies_) {
    obstacles_[number]->body()->expect_nodes();
    obstacles_[number]->move_to(step);
  }
}

void RigidDynamics::set_nodal_impulse(std::size_t obstacle, const CentralImpulse& impulse) {
  obstacles_[obstacle]->body()->set_nodal_impulse(impulse);
  obstacles_[obstacle]->move_to(step_);
}

CentralImpulse RigidDynamics::central(std::size_t obstacle, const Vec3d& linear, const Vec3d& angular) const {
  return {linear, angular - cross(body(obstacle).center() - obstacles_[obstacle]->state().origin, linear)};
}

std::vector<std::pair<std::string, double>> RigidDynamics::state() const {
  std::vector<std::pair<std::string, double>> all;
  for (const auto number : bodies_) {
    const auto saved = obstacles_[number]->body()->save();
    for (std::size_t i = 0; i < saved.size(); ++i)
      all.emplace_back("obstacles." + obstacles_[number]->name() + ".state_" + std::to_string(i), saved[i]);
  }
  return all;
}

void RigidDynamics::restore(std::span<const std::pair<std::string, double>> kept, double time) {
  std::array<double, RigidBody::state_size> saved{};
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    for (std::size_t i = 0; i < saved.size(); ++i) saved[i] = kept[b * saved.size() + i].second;
    obstacles_[bodies_[b]]->body()->restore(saved, time);
    obstacles_[bodies_[b]]->move_to({time, 0});
  }
}

}  // namespace evert
