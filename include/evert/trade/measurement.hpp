#pragma once
#include "evert/trade/point_locator.hpp"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace evert::trade {

/// A probe: a point at rest whose way is followed.
struct Probe {
  std::string name;
  BodyPoint point;
};

/// Where and when runs are measured: the same for all settings of a sweep.
struct SamplePlan {
  double end_time = 0;            ///< [s]
  int fields = 0;                 ///< times, equally spaced up to the end, of the displacement and of sums
  int probe_times = 0;            ///< the same for the probes
  std::vector<BodyPoint> points;  ///< where the displacement is looked at
  std::vector<double> weights;    ///< share of the mass that each point stands for
  std::vector<Probe> probes;

  [[nodiscard]] double field_time(int i) const { return end_time * (i + 1) / fields; }       ///< [s]
  [[nodiscard]] double probe_time(int i) const { return end_time * (i + 1) / probe_times; }  ///< [s]
};

/// What a run did at the times of the plan, and up to where it came.
struct Measurement {
  std::vector<double> displacement;  ///< [m] x y z per point, all points per time
  std::vector<double> probes;        ///< [m] displacement, x y z per probe, all probes per time
  std::vector<double> kinetic;       ///< [J] per field time
  std::vector<double> potential;     ///< [J] elastic and gravitational, per field time
  std::vector<double> volume;        ///< [m³] per field time
};

enum class Fate {
  finished,
  unstable,  ///< the simulation failed, or went astray
  too_slow,  ///< stopped at the limit of its time
  refused    ///< no such simulation can be built
};
[[nodiscard]] const char* name_of(Fate fate);

/// One setting and what became of it.
struct RunRecord {
  Fate fate = Fate::finished;
  std::string message;              ///< why it did not finish
  double reached = 0;               ///< [s] simulated
  std::vector<double> cpu_seconds;  ///< of each repetition, all ranks, without set-up and measuring
  double memory = 0;                ///< [bytes] of the heap that the simulation takes, all ranks
  double steps = 0;
  double nodes = 0;
  Measurement measured;

  /// The least of the repetitions, per simulated second.
  [[nodiscard]] double cost() const;
};

/// "name=x,y,z" or "name=body:x,y,z"; without a body the first of `bodies`. Throws UserError.
[[nodiscard]] Probe parse_probe(const std::string& text, const std::vector<std::string>& bodies);

}  // namespace evert::trade
