#pragma once
#include "evert/scene/build.hpp"
#include "evert/sim/simulation.hpp"
#include "evert/trade/measurement.hpp"

#include <optional>
#include <vector>

namespace evert::trade {

/// How much is measured of a run.
struct SampleOptions {
  int fields = 40;         ///< times of the displacement field
  int probe_times = 400;   ///< times of the probes
  int most_points = 4000;  ///< points of the field, spread evenly over the nodes
};

/// Collective. Looks at the nodes of a scene: those of the finest mesh that is not refined yet. Without
/// `probes`, there is one in the middle of each body and one far from it.
[[nodiscard]] SamplePlan make_plan(const BuiltScene& scene, double end_time, const SampleOptions& options,
                                   std::vector<Probe> probes);

/// Measures a running simulation at the times of a plan. Steps go on as they would: between them, positions
/// are interpolated by cubics that have the velocities, sums linearly.
class Sampler {
 public:
  /// Collective.
  Sampler(const SamplePlan& plan, const Simulation& simulation);

  /// Collective. Call at the start and after every step.
  void observe(const Simulation& simulation);
  /// The next time of the plan [s], for runs whose steps depend on where they stop.
  [[nodiscard]] double next_time() const;
  /// Collective. What was measured; full on rank 0 only.
  [[nodiscard]] Measurement collect() const;
  /// Processor time of this rank that measuring has taken [s].
  [[nodiscard]] double cpu_seconds() const { return cpu_seconds_; }

 private:
  /// A point that this rank looks at.
  struct OwnPoint {
    std::size_t index = 0;
    PointLocator::Place place;
    Vec3d rest{};  ///< where the cells have it [m]: not quite at the point where that is outside
  };
  [[nodiscard]] std::vector<OwnPoint> own_points(const std::vector<BodyPoint>& points) const;
  /// Collective. Puts the positions at `time`, which lies in the last step, into x_.
  void interpolate(const Simulation& simulation, double time);
  void take(const std::vector<OwnPoint>& own, std::size_t points, std::vector<double>& out) const;
  void take_sums(const Simulation& simulation, double time, const Measurements& now);
  [[nodiscard]] double own_volume() const;
  void sample(const Simulation& simulation);

  const SamplePlan& plan_;
  const DistributedMesh& mesh_;
  PointLocator locator_;
  std::vector<OwnPoint> points_, probes_;
  NodeField x_;
  Halo halo_;
  std::vector<double> last_x_, last_v_;
  double last_time_ = 0;
  std::optional<Measurements> last_sums_;
  int next_field_ = 0, next_probe_ = 0;
  Measurement own_;  // of this rank; sums are those of all
  double cpu_seconds_ = 0;
};

}  // namespace evert::trade
