#include "evert/trade/comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace evert::trade {
namespace {

SamplePlan plan_of(std::size_t points) {
  SamplePlan plan{.end_time = 2, .fields = 2, .probe_times = 200, .points = {}, .weights = {}, .probes = {}};
  for (std::size_t p = 0; p < points; ++p) {
    plan.points.push_back({"body", {static_cast<double>(p), 0, 0}});
    plan.weights.push_back(1 / static_cast<double>(points));
  }
  plan.probes.push_back({"tip", plan.points.back()});
  return plan;
}

/// A point that goes to and fro at `frequency` [Hz]; all else in proportion to `size`.
Measurement vibration(const SamplePlan& plan, double size, double frequency) {
  Measurement m;
  for (int i = 0; i < plan.fields; ++i)
    for (std::size_t p = 0; p < plan.points.size(); ++p)
      m.displacement.insert(m.displacement.end(), {size * static_cast<double>(p + 1), 0, 0});
  for (int i = 0; i < plan.probe_times; ++i)
    m.probes.insert(m.probes.end(),
                    {size * std::sin(2 * std::numbers::pi * frequency * plan.probe_time(i)), 0, 0});
  m.kinetic = {0, size};
  m.potential = {-5, -5};
  m.volume = {2 * size, 2 * size};
  return m;
}

TEST(Comparison, ErrorsAreRelativeToTheReference) {
  const auto plan = plan_of(3);
  const auto errors = compare(plan, vibration(plan, 1.1, 3), vibration(plan, 1, 3));
  EXPECT_NEAR(errors.displacement, 0.1, 1e-12);
  EXPECT_NEAR(errors.probes, 0.1, 1e-12);
  EXPECT_NEAR(errors.energy, 0.1 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(errors.volume, 0.1, 1e-12);
  EXPECT_NEAR(errors.frequency, 0, 1e-9);
}

TEST(Comparison, HeavyPointsCountForMore) {
  auto plan = plan_of(2);
  plan.weights = {0.9, 0.1};
  auto reference = vibration(plan, 0, 1), run = reference;
  for (std::size_t i = 0; i < reference.displacement.size(); i += 3) reference.displacement[i] = 1;
  run.displacement = reference.displacement;
  run.displacement[0] = run.displacement[6] = 2;  // the heavy one
  EXPECT_NEAR(displacement_error(plan, run, reference), std::sqrt(0.9), 1e-12);
}

TEST(Comparison, AWrongFrequencyIsSeen) {
  const auto plan = plan_of(1);
  EXPECT_NEAR(compare(plan, vibration(plan, 1, 3.15), vibration(plan, 1, 3)).frequency, 0.05, 5e-3);
}

TEST(Comparison, FrequenciesBetweenThoseOfTheTransformAreFound) {
  std::vector<double> values;
  for (int i = 0; i < 400; ++i) values.push_back(5 + 0.01 * i + std::cos(2 * std::numbers::pi * 0.0413 * i));
  EXPECT_NEAR(dominant_frequency(values, 0.5), 0.0413 / 0.5, 1e-3 * 0.0413 / 0.5);
  EXPECT_EQ(dominant_frequency(std::vector<double>(400, 3.0), 0.5), 0);
}

TEST(Reference, SecondOrderIsRecognisedAndTakenAway) {
  const auto plan = plan_of(4);
  // u(h) = 1 + 0.16 h² at h = 1, 1/2, 1/4
  const auto u0 = vibration(plan, 1.16, 1), u1 = vibration(plan, 1.04, 1), u2 = vibration(plan, 1.01, 1);
  const auto quality = assess_reference(plan, u0, u1, u2);
  EXPECT_TRUE(quality.converges);
  EXPECT_NEAR(quality.reduction, 4, 0.3) << "differences are relative to different levels";
  EXPECT_LE(quality.least, 0.01);
  EXPECT_GE(quality.most, 0.01);
  EXPECT_NEAR(quality.error, 0.01, 1e-3);
  const auto best = best_reference(quality, u1, u2);
  EXPECT_NEAR(displacement_error(plan, best, vibration(plan, 1, 1)), 0, 1e-3);
}

TEST(Reference, WhatDoesNotConvergeIsSaidSo) {
  const auto plan = plan_of(4);
  const auto u0 = vibration(plan, 1, 1), u1 = vibration(plan, 1.1, 1), u2 = vibration(plan, 0.95, 1);
  const auto quality = assess_reference(plan, u0, u1, u2);
  EXPECT_FALSE(quality.converges);
  EXPECT_GT(quality.most, quality.second);
  EXPECT_EQ(best_reference(quality, u1, u2).displacement, u2.displacement);
}

TEST(Reference, EqualRunsHaveNoError) {
  const auto plan = plan_of(4);
  const auto u = vibration(plan, 1, 1);
  EXPECT_EQ(assess_reference(plan, u, u, u).most, 0);
}

TEST(Probe, IsReadFromText) {
  const auto probe = parse_probe("tip=arm:1,-0.5,2e-3", {"leg", "arm"});
  EXPECT_EQ(probe.name, "tip");
  EXPECT_EQ(probe.point.body, "arm");
  EXPECT_EQ(probe.point.position, (Vec3d{1, -0.5, 2e-3}));
  EXPECT_EQ(parse_probe("tip=0,0,1", {"leg"}).point.body, "leg");
  for (const auto* wrong : {"tip", "=1,2,3", "tip=1,2", "tip=1,2,x", "tip=1,2,3,4", "tip=head:1,2,3"})
    EXPECT_ANY_THROW(static_cast<void>(parse_probe(wrong, {"leg"}))) << wrong;
}

}  // namespace
}  // namespace evert::trade
