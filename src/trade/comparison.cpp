#include "evert/trade/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace evert::trade {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

double rms_difference(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size() || a.empty()) return not_a_number;
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// 0/0 is no error.
double ratio(double difference, double scale) { return difference == 0 ? 0 : difference / scale; }

/// Σ over times and points of weight · |a − b|²; b may be empty: 0.
double weighted_square(const SamplePlan& plan, std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  const std::size_t points = plan.points.size();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = a[i] - (b.empty() ? 0 : b[i]);
    sum += plan.weights[i / 3 % points] * d * d;
  }
  return sum;
}

std::vector<double> total_energy(const Measurement& run) {
  auto total = run.kinetic;
  for (std::size_t i = 0; i < total.size(); ++i) total[i] += run.potential[i];
  return total;
}

/// What the energy varies by, of either kind: the zero of the potential one is arbitrary.
double energy_scale(const Measurement& reference) {
  double scale = 0;
  for (const auto& energy : {reference.kinetic, reference.potential}) {
    const auto [low, high] = std::ranges::minmax_element(energy);
    if (low != energy.end()) scale = std::max(scale, *high - *low);
  }
  for (const double kinetic : reference.kinetic) scale = std::max(scale, kinetic);
  return scale;
}

/// The values of one component of one probe.
std::vector<double> track(const Measurement& run, std::size_t component, std::size_t width) {
  std::vector<double> values;
  for (std::size_t i = component; i < run.probes.size(); i += width) values.push_back(run.probes[i]);
  return values;
}

/// Takes the straight line away that fits best.
void remove_trend(std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double middle = 0.5 * (n - 1);
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double slope = 0, square = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double t = static_cast<double>(i) - middle;
    slope += t * values[i];
    square += t * t;
  }
  slope /= square;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] -= mean + slope * (static_cast<double>(i) - middle);
}

/// |Σ values exp(−2πi f t)|², f in cycles a sample.
double power(std::span<const double> values, double f) {
  double real = 0, imaginary = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double angle = 2 * std::numbers::pi * f * static_cast<double>(i);
    real += values[i] * std::cos(angle);
    imaginary += values[i] * std::sin(angle);
  }
  return real * real + imaginary * imaginary;
}

/// Of the component of a probe that moves most in the reference.
double frequency_error(const SamplePlan& plan, const Measurement& run, const Measurement& reference) {
  const std::size_t width = 3 * plan.probes.size();
  std::size_t liveliest = 0;
  double most = -1;
  for (std::size_t c = 0; c < width; ++c) {
    auto values = track(reference, c, width);
    if (values.size() < 8) return not_a_number;
    remove_trend(values);
    const double square = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
    if (square > most) {
      most = square;
      liveliest = c;
    }
  }
  const double interval = plan.end_time / plan.probe_times;
  const double expected = dominant_frequency(track(reference, liveliest, width), interval);
  if (expected == 0) return not_a_number;
  return std::abs(dominant_frequency(track(run, liveliest, width), interval) / expected - 1);
}

}  // namespace

double dominant_frequency(std::span<const double> values, double interval) {
  if (values.size() < 8) return 0;
  std::vector<double> changes(values.begin(), values.end());
  remove_trend(changes);
  const auto n = static_cast<double>(changes.size());
  constexpr double finer = 8;  // than those of the transform
  double best = 0, most = 0;
  for (double f = 1 / n; f < 0.5; f += 1 / (finer * n)) {
    const double here = power(changes, f);
    if (here > most) {
      most = here;
      best = f;
    }
  }
  if (most == 0) return 0;
  // Golden-section search around it.
  constexpr double section = 0.6180339887498949;
  double low = best - 1 / (finer * n), high = best + 1 / (finer * n);
  for (int i = 0; i < 40; ++i) {
    const double a = high - section * (high - low), b = low + section * (high - low);
    if (power(changes, a) > power(changes, b))
      high = b;
    else
      low = a;
  }
  return 0.5 * (low + high) / interval;
}

double displacement_error(const SamplePlan& plan, const Measurement& run, const Measurement& reference) {
  if (run.displacement.size() != reference.displacement.size()) return not_a_number;
  return std::sqrt(ratio(weighted_square(plan, run.displacement, reference.displacement),
                         weighted_square(plan, reference.displacement, {})));
}

Errors compare(const SamplePlan& plan, const Measurement& run, const Measurement& reference) {
  const std::vector<double> zero(reference.probes.size(), 0.0);
  const double mean_volume = std::accumulate(reference.volume.begin(), reference.volume.end(), 0.0) /
                             static_cast<double>(reference.volume.size());
  return {
      .displacement = displacement_error(plan, run, reference),
      .probes = ratio(rms_difference(run.probes, reference.probes), rms_difference(reference.probes, zero)),
      .energy = ratio(rms_difference(total_energy(run), total_energy(reference)), energy_scale(reference)),
      .volume = ratio(rms_difference(run.volume, reference.volume), mean_volume),
      .frequency = frequency_error(plan, run, reference)};
}

ReferenceQuality assess_reference(const SamplePlan& plan, const Measurement& level0,
                                  const Measurement& level1, const Measurement& level2) {
  ReferenceQuality quality;
  quality.first = displacement_error(plan, level0, level1);
  quality.second = displacement_error(plan, level1, level2);
  if (quality.second == 0) return quality;
  quality.reduction = quality.first / quality.second;
  // Less: no order that a method has, or chaos. More: something else than the refinement is seen.
  constexpr double least = 1.3, most = 50;
  quality.converges = quality.reduction > least && quality.reduction < most;
  if (quality.converges) {
    constexpr double margin = 1.5;
    quality.error = quality.second / (quality.reduction - 1);
    quality.least = quality.error / margin;
    quality.most = quality.error * margin;
  } else {
    quality.error = quality.reduction >= most ? quality.second / (most - 1) : quality.second;
    quality.most = 3 * quality.second;
  }
  return quality;
}

Measurement best_reference(const ReferenceQuality& quality, const Measurement& level1,
                           const Measurement& level2) {
  if (!quality.converges) return level2;
  auto best = level2;
  const double factor = 1 / (quality.reduction - 1);
  const auto extrapolate = [&](std::vector<double>& values, const std::vector<double>& coarser) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += factor * (values[i] - coarser[i]);
  };
  extrapolate(best.displacement, level1.displacement);
  extrapolate(best.probes, level1.probes);
  extrapolate(best.kinetic, level1.kinetic);
  extrapolate(best.potential, level1.potential);
  extrapolate(best.volume, level1.volume);
  return best;
}

}  // namespace evert::trade
