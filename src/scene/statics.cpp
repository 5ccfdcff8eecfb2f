#include "statics.hpp"

#include "evert/core/schema.hpp"

#include <algorithm>

namespace evert {

using schema::Value;

void require_rest(const SceneConfig& scene, const Value& root) {
  if (scene.integrator.method != IntegrationMethod::quasistatic) return;
  if (!scene.obstacles.empty())
    schema::fail(*root.find("obstacles"), "obstacles",
                 "is not possible with 'integrator.method: quasistatic', which knows no contact: 'newmark' "
                 "with damping "
                 "does");
  const auto pulls = [](const Vec3d& gravity) { return norm(gravity) > 0; };
  const bool heavy =
      pulls(scene.gravity) || std::any_of(scene.events.begin(), scene.events.end(), [&](const auto& event) {
        return event.target == EventTarget::gravity && pulls(event.vector);
      });
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const bool held = std::any_of(scene.constraints.begin(), scene.constraints.end(),
                                  [b](const auto& constraint) { return constraint.body == b; });
    const auto& name = scene.bodies[b].name;
    if (heavy && !held)
      schema::fail(*root.find("bodies")->find(name), "bodies." + name,
                   "falls for ever: with gravity, 'integrator.method: quasistatic' needs 'constraints' that "
                   "hold every body");
  }
}

}  // namespace evert
