#include "evert/core/collective.hpp"
#include "evert/trade/sampler.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace evert::trade {
namespace {

/// What is gathered of a node: x, y, z [m], mass [kg], original number.
constexpr std::size_t columns = 5;

/// Collective. All nodes in natural order, on every rank.
std::vector<double> gathered_nodes(const Simulation& simulation) {
  const auto& mesh = simulation.mesh();
  std::vector<double> nodes(columns * static_cast<std::size_t>(mesh.total_nodes));
  for (std::size_t i = 0; i < static_cast<std::size_t>(mesh.owned_nodes); ++i) {
    auto* row = &nodes[columns * static_cast<std::size_t>(mesh.natural_nodes[i])];
    std::ranges::copy(mesh.rest_positions[i].components, row);
    row[3] = simulation.elastic().masses()[i];
    row[4] = static_cast<double>(mesh.original_nodes[i]);
  }
  MPI_Allreduce(MPI_IN_PLACE, nodes.data(), static_cast<int>(nodes.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  return nodes;
}

const BodyRange& body_of(const std::vector<BodyRange>& bodies, double node) {
  for (const auto& body : bodies)
    if (node < static_cast<double>(body.end_node)) return body;
  return bodies.back();
}

std::vector<Probe> default_probes(const SamplePlan& plan, const std::vector<BodyRange>& bodies) {
  std::vector<Probe> probes;
  for (const auto& body : bodies) {
    const auto distance = [&](const BodyPoint& point) {
      return point.body == body.name ? norm(point.position - body.center_of_volume) : -1.0;
    };
    probes.push_back({body.name + ".middle", {body.name, body.center_of_volume}});
    // Two points that are opposite each other: where one is held the other may move.
    const auto far = std::ranges::max_element(plan.points, {}, distance);
    const auto opposite = std::ranges::max_element(plan.points, {}, [&](const BodyPoint& point) {
      return point.body == body.name ? norm(point.position - far->position) : -1.0;
    });
    probes.push_back({body.name + ".end", *far});
    probes.push_back({body.name + ".other_end", *opposite});
  }
  return probes;
}

}  // namespace

SamplePlan make_plan(const BuiltScene& scene, double end_time, const SampleOptions& options,
                     std::vector<Probe> probes) {
  const auto nodes = gathered_nodes(*scene.simulation);
  const std::size_t count = nodes.size() / columns;
  const std::size_t stride =
      std::max<std::size_t>(1, (count - 1) / static_cast<std::size_t>(options.most_points) + 1);
  SamplePlan plan{.end_time = end_time,
                  .fields = options.fields,
                  .probe_times = options.probe_times,
                  .points = {},
                  .weights = {},
                  .probes = std::move(probes)};
  for (std::size_t n = 0; n < count; n += stride) {
    const auto* row = &nodes[columns * n];
    plan.points.push_back({body_of(scene.bodies, row[4]).name, {row[0], row[1], row[2]}});
    plan.weights.push_back(row[3]);
  }
  const double mass = std::accumulate(plan.weights.begin(), plan.weights.end(), 0.0);
  for (auto& weight : plan.weights) weight /= mass;
  if (plan.probes.empty()) plan.probes = default_probes(plan, scene.bodies);
  return plan;
}

}  // namespace evert::trade
