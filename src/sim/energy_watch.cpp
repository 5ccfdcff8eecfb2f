#include "evert/sim/energy_watch.hpp"

#include "evert/math/nodal.hpp"

#include <array>
#include <cmath>

namespace evert {

EnergyWatch::Obstacles EnergyWatch::obstacles_of(const System& system) {
  Obstacles all;
  for (const auto& [linear, angular] : system.obstacle_impulses)
    all.impulses += dot(linear, linear) + dot(angular, angular);
  for (const auto& obstacle : system.collisions.obstacles()) {
    const auto& state = obstacle->state();
    all.moves = all.moves || obstacle->body() != nullptr || dot(state.velocity, state.velocity) > 0 ||
                dot(state.angular_velocity, state.angular_velocity) > 0;
    for (std::size_t k = 0; k < 3; ++k) {
      all.poses += (1 + static_cast<double>(k)) * state.origin[k];
      for (std::size_t j = 0; j < 3; ++j)
        all.poses += (1 + static_cast<double>(3 * k + j)) * state.rotation.column[k][j];
    }
  }
  return all;
}

EnergyWatch::Energies EnergyWatch::energies_of(const System& system) {
  const auto mass = system.mass_row_sums();
  std::array<double, 5> sums{};
  const auto now = obstacles_of(system);
  sums[4] = now.impulses != obstacles_.impulses && (now.moves || now.poses != obstacles_.poses) ? 1 : 0;
  obstacles_ = now;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const auto node = static_cast<std::ptrdiff_t>(i);
    const auto x = node_value(system.x.owned(), node);
    const auto v = node_value(system.v.owned(), node);
    sums[0] += 0.5 * mass[i] * dot(v, v);
    sums[1] -= mass[i] * dot(system.gravity, x);
    sums[2] += mass[i] * dot(v, v);
    sums[3] += mass[i] * dot(x, x);
  }
  sums[0] += system.elastic.energy(system.x);
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), sums.size(), MPI_DOUBLE, MPI_SUM, system.mesh.comm);
  return {sums[0], sums[1], sums[2], sums[3], sums[4] > 0};
}

bool EnergyWatch::has_grown(const System& system, double dt) {
  if (!closed_ || looks_++ % interval != 0) return false;
  const auto now = energies_of(system);
  if (looks_ == 1 || now.touched) {
    first_ = now;
    return false;
  }
  // What rounding makes of rest is no motion.
  constexpr double rounding = 1e-8;  // of the size, in a step
  const bool moves = now.square * dt * dt > rounding * rounding * now.reach;
  return moves && grows_beyond(limit, now);
}

bool EnergyWatch::is_growing(const System& system) {
  if (!closed_ || looks_ == 0) return false;
  const auto now = energies_of(system);
  if (now.touched) first_ = now;
  return grows_beyond(limit / 10, now);
}

bool EnergyWatch::grows_beyond(double factor, const Energies& now) {
  const double gained = now.moving + now.potential - first_.moving - first_.potential;
  const double given = first_.moving + std::abs(now.potential - first_.potential);
  growth_ = now.moving / given;
  return gained > 0.5 * now.moving && now.moving > factor * given;
}

}  // namespace evert
