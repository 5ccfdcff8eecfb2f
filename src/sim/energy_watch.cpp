#include "evert/sim/energy_watch.hpp"

#include "evert/math/nodal.hpp"

#include <array>
#include <cmath>

namespace evert {

EnergyWatch::Energies EnergyWatch::energies_of(const System& system) {
  const auto mass = system.mass_row_sums();
  std::array<double, 4> sums{};
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
  return {sums[0], sums[1], sums[2], sums[3]};
}

bool EnergyWatch::has_grown(const System& system, double dt) {
  if (!closed_ || looks_++ % interval != 0) return false;
  const auto now = energies_of(system);
  if (looks_ == 1) {
    first_ = now;
    return false;
  }
  const double gained = now.moving + now.potential - first_.moving - first_.potential;
  const double given = first_.moving + std::abs(now.potential - first_.potential);
  // What rounding makes of rest is no motion.
  constexpr double rounding = 1e-8;  // of the size, in a step
  const bool moves = now.square * dt * dt > rounding * rounding * now.reach;
  growth_ = now.moving / given;
  return moves && gained > 0.5 * now.moving && now.moving > limit * given;
}

}  // namespace evert
