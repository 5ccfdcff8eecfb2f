#include "evert/sim/soundness.hpp"

#include "evert/core/collective.hpp"
#include "evert/math/nodal.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace evert {
namespace {

constexpr double light_speed = 299792458;  // [m/s]

/// True where every |value| is at most `limit` and none is NaN. The bits of a magnitude are ordered as the
/// magnitude, infinity and NaN above all: integers alone, so that this runs at the speed of memory.
bool all_within(std::span<const double> values, double limit) {
  constexpr auto sign = std::uint64_t{1} << 63U;
  const auto highest = std::bit_cast<std::uint64_t>(limit);
  std::uint64_t below_zero = 0;
  for (const double value : values) below_zero |= highest - (std::bit_cast<std::uint64_t>(value) & ~sign);
  return (below_zero & sign) == 0;
}

/// A velocity of which components grow without bound is noticed long before it overflows; positions follow.
bool sound(std::span<const double> positions, std::span<const double> velocities) {
  return all_within(positions, std::numeric_limits<double>::max()) && all_within(velocities, light_speed);
}

GlobalIndex unsound_nodes(std::span<const double> x, std::span<const double> v) {
  if (sound(x, v)) return 0;
  GlobalIndex count = 0;
  for (std::size_t i = 0; i < x.size(); i += 3) count += sound(x.subspan(i, 3), v.subspan(i, 3)) ? 0 : 1;
  return count;
}

/// The rank with the largest `value`, and that value, on every rank.
struct ValueAt {
  double value;
  int rank;
};
ValueAt largest_over_ranks(MPI_Comm comm, double value) {
  ValueAt largest{value, rank_of(comm)};
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm);
  return largest;
}

/// Entry and number of a cell of this rank with the local node; of a node without one the first there is.
std::array<std::size_t, 2> cell_with(const DistributedMesh& mesh, LocalIndex node) {
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    const auto& nodes = mesh.cells[e].nodes;
    const auto found = std::ranges::find(nodes, node);
    if (found != nodes.end())
      return {e, static_cast<std::size_t>(found - nodes.begin()) / node_count(mesh.cells[e].type)};
  }
  return {mesh.cells.size(), 0};
}

}  // namespace

Soundness::Findings Soundness::look(const System& system, double dt, bool stop_requested) {
  const auto x = system.x.owned();
  const auto v = system.v.owned();
  const auto part = watch_.look(system.mass_row_sums(), v);
  std::array<double, 4> sums{static_cast<double>(unsound_nodes(x, v)), stop_requested ? 1.0 : 0.0,
                             part.turned, part.square};
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), sums.size(), MPI_DOUBLE, MPI_SUM, system.mesh.comm);
  Findings found{.unsound_nodes = static_cast<GlobalIndex>(sums[0]), .stop = sums[1] > 0};
  for (const auto number : system.rigid.bodies()) {  // every rank has all of them
    const auto& body = system.rigid.body(number);
    if (!sound(body.center().components, body.velocity().components) ||
        !all_within(body.angular_velocity().components, light_speed)) {
      found.ailment = Ailment::unsound_rigid_body;
      found.obstacle = number;
      return found;
    }
  }
  if (found.unsound_nodes > 0) {
    found.ailment = Ailment::unsound_nodes;
    return found;
  }
  watch_.judge({sums[2], sums[3]});
  if (watch_.exploding())
    found.ailment = Ailment::explosion;
  else if (energy_.has_grown(system, dt))
    found.ailment = Ailment::energy;
  return found;
}

WorstNode worst_node(const System& system) {
  const auto& mesh = system.mesh;
  const auto x = system.x.owned();
  const auto v = system.v.owned();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double worst = -1;
  LocalIndex node = 0;
  for (LocalIndex i = 0; i < mesh.owned_nodes; ++i) {
    const auto velocity = node_value(v, i);
    const auto position = node_value(x, i);
    double speed = std::sqrt(dot(velocity, velocity));
    if (!std::isfinite(speed) || !std::isfinite(dot(position, position))) speed = infinity;
    if (speed > worst) {
      worst = speed;
      node = i;
    }
  }
  const auto largest = largest_over_ranks(mesh.comm, worst);
  std::array<GlobalIndex, 3> numbers{0, 0, -1};
  if (largest.rank == rank_of(mesh.comm)) {
    const auto [entry, cell] = cell_with(mesh, node);
    numbers[0] = mesh.original_nodes[static_cast<std::size_t>(node)];
    if (entry < mesh.cells.size()) {
      numbers[1] = mesh.cells[entry].global_ids[cell];
      numbers[2] = mesh.cells[entry].region;
    }
  }
  MPI_Bcast(numbers.data(), numbers.size(), MPI_INT64_T, largest.rank, mesh.comm);
  return {.node = numbers[0],
          .cell = numbers[1],
          .region = numbers[2] < 0 ? "" : mesh.regions[static_cast<std::size_t>(numbers[2])],
          .rank = largest.rank,
          .speed = largest.value};
}

}  // namespace evert
