#include "evert/contact/obstacle.hpp"

#include <cmath>
#include <utility>

namespace evert {
namespace {

/// Around the box of the body, which turns with it.
Box3 in_world(const Box3& box, const RigidState& state) {
  const auto center = 0.5 * (box.lower + box.upper), half = 0.5 * (box.upper - box.lower);
  if (!std::isfinite(norm(half))) return Box3::everything();
  Vec3d reach{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) reach[i] += std::abs(state.rotation(i, j)) * half[j];
  const auto middle = state.to_world(center);
  return {middle - reach, middle + reach};
}

}  // namespace

Obstacle::Obstacle(std::string name, double friction, std::unique_ptr<ImplicitSurface> surface,
                   std::unique_ptr<RigidMotion> motion)
    : name_(std::move(name)), friction_(friction), surface_(std::move(surface)), motion_(std::move(motion)) {
  move_to({.end = 0, .dt = 1});
}

void Obstacle::move_to(const StepInterval& step) {
  step_ = step;
  before_ = motion_->at(step.end - step.dt);
  now_ = motion_->at(step.end);
  bounds_ = in_world(surface_->bounds(), now_);
  const auto was = in_world(surface_->bounds(), before_);
  bounds_.include(was.lower);
  bounds_.include(was.upper);
}

}  // namespace evert
