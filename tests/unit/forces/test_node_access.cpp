#include "evert/forces/kernels/node_access.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"
#include <array>
#include <cstring>

/// Gather and scatter of every width; the widest also where no register is as wide.
namespace evert::kernels {
namespace {

template <class T>
class NodeAccess : public testing::Test {};
using Widths = testing::Types<double, BasicPack<double, 2>, BasicPack<double, 4>, BasicPack<double, 8>, Pack>;
TYPED_TEST_SUITE(NodeAccess, Widths);

constexpr std::size_t node_total = 20;

test::NodalValues numbered() {
  test::NodalValues values(3 * node_total + 1);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i * i);
  return values;
}

/// [node][lane]; lanes share nodes.
template <class T>
std::vector<LocalIndex> four_nodes_per_lane() {
  std::vector<LocalIndex> nodes(4 * lanes_v<T>);
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = static_cast<LocalIndex>((7 * i + 3) % node_total);
  nodes[0] = static_cast<LocalIndex>(node_total - 1);  // reads the slack
  return nodes;
}

TYPED_TEST(NodeAccess, GathersDifferencesToTheFirstNode) {
  const auto values = numbered();
  const auto nodes = four_nodes_per_lane<TypeParam>();
  const auto edges = gather_edges<TypeParam, 4>(values.data(), nodes.data());
  for (std::size_t l = 0; l < lanes_v<TypeParam>; ++l) {
    const auto value = [&](std::size_t a) {
      return test::at_node(values, static_cast<std::size_t>(nodes[a * lanes_v<TypeParam> + l]));
    };
    for (std::size_t a = 1; a < 4; ++a) {
      for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(lane(edges[a - 1][i], l), (value(a) - value(0))[i]);
    }
  }
}

TYPED_TEST(NodeAccess, ScattersEveryLaneOnceAndBalances) {
  const auto nodes = four_nodes_per_lane<TypeParam>();
  Edges<TypeParam, 4> forces;
  const auto number = [](std::size_t a, std::size_t i, std::size_t l) {
    return static_cast<double>(100 * a + 10 * i + l + 1);
  };
  for (std::size_t a = 1; a < 4; ++a) {
    for (std::size_t i = 0; i < 3; ++i) {
      forces[a - 1][i] = generate<TypeParam>([&](std::size_t l) { return number(a, i, l); });
    }
  }
  auto values = numbered();
  auto expected = numbered();
  scatter_balanced<TypeParam, 4>(forces, values.data(), nodes.data());
  for (std::size_t l = 0; l < lanes_v<TypeParam>; ++l) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t a = 1; a < 4; ++a) {
        expected[3 * static_cast<std::size_t>(nodes[a * lanes_v<TypeParam> + l]) + i] += number(a, i, l);
        expected[3 * static_cast<std::size_t>(nodes[l]) + i] -= number(a, i, l);
      }
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], expected[i]) << i;
}

}  // namespace
}  // namespace evert::kernels
