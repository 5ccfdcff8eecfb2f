#include "evert/trade/sampler.hpp"

#include "evert/core/collective.hpp"
#include "evert/mesh/cell_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

namespace evert::trade {
namespace {

constexpr double rounding = 1e-12;

double seconds_since(std::clock_t begin) {
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

Vec3d value_at(std::span<const double> field, const PointLocator::Place& place) {
  Vec3d sum{};
  for (std::size_t a = 0; a < place.count; ++a)
    for (std::size_t i = 0; i < 3; ++i)
      sum[i] += place.weights[a] * field[3 * static_cast<std::size_t>(place.nodes[a]) + i];
  return sum;
}

void reduce(MPI_Comm comm, std::vector<double>& values) {
  const bool root = rank_of(comm) == 0;
  MPI_Reduce(root ? MPI_IN_PLACE : values.data(), values.data(), static_cast<int>(values.size()), MPI_DOUBLE,
             MPI_SUM, 0, comm);
}

}  // namespace

Sampler::Sampler(const SamplePlan& plan, const Simulation& simulation)
    : plan_(plan), mesh_(simulation.mesh()), locator_(mesh_), x_(mesh_), halo_(mesh_) {
  points_ = own_points(plan.points);
  std::vector<BodyPoint> at_probes;
  for (const auto& probe : plan.probes) at_probes.push_back(probe.point);
  probes_ = own_points(at_probes);
}

std::vector<Sampler::OwnPoint> Sampler::own_points(const std::vector<BodyPoint>& points) const {
  struct Claim {
    double outside;
    int rank;
  };
  std::vector<PointLocator::Place> places;
  std::vector<Claim> claims;
  const int rank = rank_of(mesh_.comm);
  for (const auto& point : points) {
    places.push_back(locator_.locate(point));
    claims.push_back({places.back().outside, rank});
  }
  MPI_Allreduce(MPI_IN_PLACE, claims.data(), static_cast<int>(claims.size()), MPI_DOUBLE_INT, MPI_MINLOC,
                mesh_.comm);
  std::vector<OwnPoint> own;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (claims[p].rank != rank || places[p].count == 0) continue;
    Vec3d rest{};
    for (std::size_t a = 0; a < places[p].count; ++a)
      rest += places[p].weights[a] * mesh_.rest_positions[static_cast<std::size_t>(places[p].nodes[a])];
    own.push_back({p, places[p], rest});
  }
  return own;
}

double Sampler::next_time() const {
  double next = std::numeric_limits<double>::infinity();
  if (next_field_ < plan_.fields) next = std::min(next, plan_.field_time(next_field_));
  if (next_probe_ < plan_.probe_times) next = std::min(next, plan_.probe_time(next_probe_));
  return next;
}

void Sampler::observe(const Simulation& simulation) {
  const auto begin = std::clock();
  sample(simulation);
  const auto x = simulation.positions().owned(), v = simulation.velocities().owned();
  last_x_.assign(x.begin(), x.end());
  last_v_.assign(v.begin(), v.end());
  last_time_ = simulation.time();
  cpu_seconds_ += seconds_since(begin);
}

void Sampler::sample(const Simulation& simulation) {
  const double time = simulation.time() * (1 + rounding);
  const double dt = simulation.time() - last_time_;
  // The step to come may be longer.
  constexpr double growth = 2;
  const bool needs_sums = next_field_ < plan_.fields && plan_.field_time(next_field_) <= time + growth * dt;
  std::optional<Measurements> now;
  if (needs_sums) now = simulation.measure();
  while (next_field_ < plan_.fields && plan_.field_time(next_field_) <= time) {
    interpolate(simulation, plan_.field_time(next_field_));
    take(points_, plan_.points.size(), own_.displacement);
    take_sums(simulation, plan_.field_time(next_field_), *now);
    ++next_field_;
  }
  while (next_probe_ < plan_.probe_times && plan_.probe_time(next_probe_) <= time) {
    interpolate(simulation, plan_.probe_time(next_probe_));
    take(probes_, plan_.probes.size(), own_.probes);
    ++next_probe_;
  }
  last_sums_ = now;
}

void Sampler::interpolate(const Simulation& simulation, double time) {
  const double dt = simulation.time() - last_time_;
  const double s = dt > 0 ? std::min(1.0, (time - last_time_) / dt) : 1;
  const auto x = simulation.positions().owned(), v = simulation.velocities().owned();
  auto out = x_.owned();
  if (s == 1 || simulation.quasistatic()) {
    std::ranges::copy(x, out.begin());
  } else {
    const double r = 1 - s;
    const double from = (1 + 2 * s) * r * r, to = s * s * (3 - 2 * s);
    const double leaving = dt * s * r * r, arriving = -dt * s * s * r;
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = from * last_x_[i] + to * x[i] + leaving * last_v_[i] + arriving * v[i];
  }
  x_.touched();
  halo_.begin_update(x_);
  halo_.end_update(x_);
}

void Sampler::take(const std::vector<OwnPoint>& own, std::size_t points, std::vector<double>& out) const {
  const std::size_t first = out.size();
  out.resize(first + 3 * points);
  for (const auto& point : own) {
    const auto u = value_at(x_.local(), point.place) - point.rest;
    for (std::size_t i = 0; i < 3; ++i) out[first + 3 * point.index + i] = u[i];
  }
}

void Sampler::take_sums(const Simulation& simulation, double time, const Measurements& now) {
  const double dt = simulation.time() - last_time_;
  const double share = last_sums_ && dt > 0 ? std::min(1.0, (time - last_time_) / dt) : 1;
  const auto& before = last_sums_ ? *last_sums_ : now;
  const auto between = [&](double a, double b) { return a + share * (b - a); };
  own_.kinetic.push_back(between(before.kinetic_energy, now.kinetic_energy));
  own_.potential.push_back(between(before.elastic_energy + before.gravitational_energy,
                                   now.elastic_energy + now.gravitational_energy));
  own_.volume.push_back(own_volume());
}

double Sampler::own_volume() const {
  double volume = 0;
  std::vector<Vec3d> corners;
  for (const auto& block : mesh_.cells) {
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    for (std::size_t c = 0; c < block.global_ids.size(); ++c) {
      corners.clear();
      for (std::size_t a = 0; a < stride; ++a) {
        const auto at = 3 * static_cast<std::size_t>(block.nodes[stride * c + a]);
        corners.push_back({x_.local()[at], x_.local()[at + 1], x_.local()[at + 2]});
      }
      volume += cell_volume(block.type, corners);
    }
  }
  return volume;
}

Measurement Sampler::collect() const {
  auto all = own_;
  reduce(mesh_.comm, all.displacement);
  reduce(mesh_.comm, all.probes);
  reduce(mesh_.comm, all.volume);
  return all;
}

}  // namespace evert::trade
