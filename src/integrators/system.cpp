#include "evert/integrators/system.hpp"

namespace evert {

System::System(const DistributedMesh& distributed, ElasticForces& elastic_forces, Collisions& node_collisions,
               PrescribedMotion& prescribed_motion, const Vec3d& gravitation)
    : mesh(distributed),
      elastic(elastic_forces),
      collisions(node_collisions),
      prescribed(prescribed_motion),
      gravity(gravitation),
      x(distributed),
      v(distributed),
      v_change(distributed),
      f(distributed) {
  const auto rest = std::span(distributed.rest_positions);
  for (std::size_t node = 0; node < rest.size(); ++node)
    for (std::size_t k = 0; k < 3; ++k) x.local()[3 * node + k] = rest[node][k];
  x.touched();
}

void System::update_forces() {
  elastic.update(x, f);
  auto force = f.owned();
  const auto mass = masses();
  for (std::size_t i = 0; i < force.size(); ++i) force[i] += mass[i / 3] * gravity[i % 3];
  f.touched();
  ++force_updates;
}

}  // namespace evert
