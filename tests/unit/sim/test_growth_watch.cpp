#include "evert/sim/growth_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

/// What is taken for an explosion, and what never is.
namespace evert {
namespace {

/// Vibrations of many frequencies, each of a node of its own, advanced by Verlet's scheme with Δt = 1.
class Vibrations {
 public:
  Vibrations(std::vector<double> frequencies, unsigned seed) : frequencies_(std::move(frequencies)) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> power(-3, 3);
    for (std::size_t i = 0; i < frequencies_.size(); ++i) {
      const double size = std::pow(10, power(random));  // far from all alike
      masses_.push_back(std::pow(10, power(random)));
      for (int k = 0; k < 3; ++k) {
        x_.push_back(size * normal(random));
        v_.push_back(size * normal(random));
      }
    }
  }

  void step() {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const double square = frequencies_[i / 3] * frequencies_[i / 3];
      v_[i] -= 0.5 * square * x_[i];
      x_[i] += v_[i];
      v_[i] -= 0.5 * square * x_[i];
    }
  }
  void rest() { std::ranges::fill(v_, 0.0); }
  [[nodiscard]] const std::vector<double>& masses() const { return masses_; }
  [[nodiscard]] const std::vector<double>& velocities() const { return v_; }

 private:
  std::vector<double> frequencies_, masses_, x_, v_;
};

/// Steps until it explodes, at most `most`.
int steps_to_explosion(Vibrations vibrations, int most) {
  GrowthWatch watch(vibrations.masses().size());
  for (int step = 0; step < most; ++step) {
    watch.judge(watch.look(vibrations.masses(), vibrations.velocities()));
    if (watch.exploding()) return step;
    vibrations.step();
  }
  return most;
}

TEST(GrowthWatch, NeverTakesStableStepsForAnExplosion) {
  constexpr int many = 20000;
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> frequency(0.01, 1.98);
    for (const double highest : {1.0, 1.8, 1.98, 1.996}) {
      std::vector<double> frequencies{highest};
      for (unsigned more = 0; more < seed % 5; ++more) frequencies.push_back(frequency(random));
      Vibrations moving(frequencies, seed);
      EXPECT_EQ(steps_to_explosion(moving, many), many) << "seed " << seed << ", up to " << highest;
      moving.rest();
      EXPECT_EQ(steps_to_explosion(moving, many), many) << "seed " << seed << " from rest, up to " << highest;
    }
  }
}

/// The square grows by A² a step; the first turn does not count, and a step more may pass before it.
TEST(GrowthWatch, SeesStepsAboveTheBoundAsSoonAsTheyHaveGrownByTheLimit) {
  for (const double frequency : {2.01, 2.1, 3.0, 6.0, 20.0}) {
    const double half = frequency * frequency / 2 - 1;
    const double factor = half + std::sqrt(half * half - 1);
    const int steps = static_cast<int>(std::ceil(std::log(GrowthWatch::limit) / (2 * std::log(factor))));
    // What does not grow of the start takes the first steps.
    EXPECT_LE(steps_to_explosion(Vibrations({frequency}, 1), 1000), steps + 6) << frequency;
  }
}

TEST(GrowthWatch, SeesOneNodeAmongManyOnceItMovesMost) {
  std::vector<double> frequencies(1000, 0.3);
  frequencies.push_back(2.5);
  EXPECT_LT(steps_to_explosion(Vibrations(frequencies, 3), 1000), 40);
}

TEST(GrowthWatch, LetsLoadsImpactsAndStartsFromRestBe) {
  const std::vector<double> mass{2.0};
  const auto explodes = [&](const auto& velocity_of_step) {
    GrowthWatch watch(1);
    for (int step = 0; step < 1000; ++step) {
      const std::vector<double> v{0, velocity_of_step(step), 0};
      watch.judge(watch.look(mass, v));
      if (watch.exploding()) return true;
    }
    return false;
  };
  EXPECT_FALSE(explodes([](int step) { return -9.81e6 * step; })) << "falls";
  EXPECT_FALSE(explodes([](int step) { return std::exp(0.5 * step); })) << "runs away without turning round";
  EXPECT_FALSE(explodes([](int step) { return step == 500 ? 1e8 : step < 500 ? -1e-6 : 0.0; })) << "is hit";
  EXPECT_FALSE(explodes([](int step) { return step % 2 == 0 ? 1.0 : -1.0; })) << "turns without growth";
  EXPECT_FALSE(explodes([](int step) { return std::sin(0.96 * std::numbers::pi * step); })) << "beats";
  EXPECT_FALSE(explodes([](int step) {
    return step < 500 ? 1e-6 * std::cos(0.9 * std::numbers::pi * step)
                      : std::cos(0.9 * std::numbers::pi * step);
  })) << "rings a little, is hit, and rings";
  EXPECT_TRUE(explodes([](int step) { return std::pow(-1.1, step); })) << "turns and grows";
}

TEST(GrowthWatch, ForgetsAndIsSuspiciousFirst) {
  const std::vector<double> mass{1.0};
  GrowthWatch watch(1);
  double v = 1;
  int suspicious = 0;
  for (int step = 0; step < 100 && !watch.exploding(); ++step, v *= -1.5) {
    watch.judge(watch.look(mass, std::vector<double>{v, 0, 0}));
    suspicious += watch.suspicious() ? 1 : 0;
  }
  EXPECT_TRUE(watch.exploding());
  EXPECT_GT(suspicious, 2);
  EXPECT_GT(watch.turns(), 5);
  watch.forget();
  EXPECT_FALSE(watch.suspicious());
  watch.judge(watch.look(mass, std::vector<double>{v, 0, 0}));
  EXPECT_FALSE(watch.suspicious());
}

}  // namespace
}  // namespace evert
