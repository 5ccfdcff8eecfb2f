#include "evert/contact/obstacle.hpp"

#include "evert/shapes/combined.hpp"

#include <utility>

namespace evert {
Obstacle::Obstacle(std::string name, double friction, std::unique_ptr<ImplicitSurface> surface,
                   std::unique_ptr<RigidMotion> motion)
    : name_(std::move(name)), friction_(friction), surface_(std::move(surface)), motion_(std::move(motion)) {
  move_to({.end = 0, .dt = 1});
}

Obstacle::Obstacle(std::string name, double friction, std::unique_ptr<ImplicitSurface> surface,
                   std::unique_ptr<RigidBody> body)
    : name_(std::move(name)),
      friction_(friction),
      surface_(std::move(surface)),
      motion_(std::move(body)),
      body_(static_cast<RigidBody*>(motion_.get())) {
  move_to({.end = 0, .dt = 1});
}

void Obstacle::move_to(const StepInterval& step) {
  step_ = step;
  before_ = motion_->at(step.end - step.dt);
  now_ = motion_->at(step.end);
  bounds_ = placed(surface_->bounds(), now_.rotation, now_.origin);
  const auto was = placed(surface_->bounds(), before_.rotation, before_.origin);
  bounds_.include(was.lower);
  bounds_.include(was.upper);
  if (!is_there()) bounds_ = {};
}

}  // namespace evert
