#include "evert/integrators/system.hpp"

namespace evert {

System::System(const DistributedMesh& distributed, ElasticForces& elastic_forces, Collisions& node_collisions,
               RigidDynamics& rigid_dynamics, PrescribedMotion& prescribed_motion, const Vec3d& gravitation,
               BodyForce force, ImplicitStrains* strains)
    : mesh(distributed),
      elastic(elastic_forces),
      collisions(node_collisions),
      rigid(rigid_dynamics),
      prescribed(prescribed_motion),
      gravity(gravitation),
      body_force(std::move(force)),
      implicit_strains(strains),
      x(distributed),
      v(distributed),
      v_change(distributed),
      f(distributed),
      obstacle_impulses(node_collisions.obstacles().size()) {
  const auto rest = std::span(distributed.rest_positions);
  for (std::size_t node = 0; node < rest.size(); ++node)
    for (std::size_t k = 0; k < 3; ++k) x.local()[3 * node + k] = rest[node][k];
  x.touched();
}

void System::update_forces(double t) {
  elastic.set_times(forces_time, t);
  forces_time = t;
  elastic.update(x, f);
  add_loads(t, f);
  ++force_updates;
}

void System::add_loads(double t, NodeField& sum) const {
  auto load = sum.owned();
  const auto mass = mass_row_sums();
  for (std::size_t i = 0; i < load.size(); ++i) load[i] += mass[i / 3] * gravity[i % 3];
  if (body_force) add_body_load(t, load);
  sum.touched();
}

void System::add_body_load(double t, std::span<double> owned) const {
  NodeField load(mesh);
  add_body_force(mesh, body_force, t, load);
  elastic.halo().begin_add(load);
  elastic.halo().end_add(load);
  for (std::size_t i = 0; i < owned.size(); ++i) owned[i] += load.owned()[i];
}

}  // namespace evert
