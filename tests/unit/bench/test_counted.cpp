#include "evert/math/vec3.hpp"

#include <gtest/gtest.h>

#include "counted.hpp"
#include <array>
#include <functional>

namespace evert::bench {
namespace {

const OperationLog& log_of(const std::function<void()>& work) {
  Counted::so_far() = {};
  work();
  return Counted::so_far();
}

const Vec3<Counted> a{1.0, 2.0, 3.0};
const Mat3<Counted> m{a, a, a};

TEST(Counted, CountsArithmetic) {
  EXPECT_EQ(log_of([] { static_cast<void>(dot(a, a)); }).flops, 5);
  EXPECT_EQ(log_of([] { static_cast<void>(m * m); }).flops, 45);
  EXPECT_EQ(log_of([] { static_cast<void>(norm(a)); }).flops, 6);
}

TEST(Counted, CountsDivisionsAndRootsApart) {
  const auto& log = log_of([] { static_cast<void>(sqrt(a[0] / a[1]) + a[2]); });
  EXPECT_EQ(log.flops, 3);
  EXPECT_EQ(log.divisions, 2);
}

TEST(Counted, DoesNotCountSelections) {
  const auto& log = log_of([] { static_cast<void>(select(a[0] < a[1], max(a[0], a[1]), abs(-a[2]))); });
  EXPECT_EQ(log.flops, 0);
}

TEST(Counted, ListsEachNumberOfMemoryOnce) {
  const std::array<double, 2> from{1, 2};
  std::array<double, 2> to{};
  const auto& log = log_of([&] {
    const auto sum = load<Counted>(&from[0]) + load<Counted>(&from[1]) + load<Counted>(&from[0]);
    store(sum, &to[1]);
  });
  EXPECT_EQ(log.read.size(), 2);
  EXPECT_EQ(log.written.size(), 1);
  EXPECT_EQ(to[1], 4);
}

}  // namespace
}  // namespace evert::bench
