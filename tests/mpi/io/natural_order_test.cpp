#include "evert/io/natural_order.hpp"

#include "evert/core/collective.hpp"

#include <gtest/gtest.h>

#include "../mesh/test_meshes.hpp"

namespace evert {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

TEST(NaturalOrder, SlicesCoverAllNodesOneRankAfterTheOther) {
  const auto mesh = distribute(world, test::mixed_row(6));
  const auto order = natural_node_order(mesh);
  GlobalIndex sum = static_cast<GlobalIndex>(order.slice_size());
  GlobalIndex before = 0;
  MPI_Exscan(&sum, &before, 1, MPI_INT64_T, MPI_SUM, world);
  EXPECT_EQ(order.first(), rank_of(world) == 0 ? 0 : before);
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_INT64_T, MPI_SUM, world);
  EXPECT_EQ(sum, mesh.total_nodes);
}

TEST(NaturalOrder, NodeValuesArriveAtTheirNumber) {
  const auto mesh = distribute(world, test::tet_cube(4));
  const auto order = natural_node_order(mesh);
  std::vector<double> values;
  for (const auto number : mesh.natural_nodes)
    for (int c = 0; c < 3; ++c) values.push_back(10.0 * static_cast<double>(number) + c);
  const auto slice = order.to_slices<double>(values, 3);
  ASSERT_EQ(slice.size(), 3 * order.slice_size());
  for (std::size_t i = 0; i < slice.size(); ++i)
    EXPECT_EQ(slice[i], 10.0 * static_cast<double>(order.first() + static_cast<GlobalIndex>(i / 3)) +
                            static_cast<double>(i % 3));
  EXPECT_EQ(order.to_owners<double>(slice, 3), values);
}

TEST(NaturalOrder, CellValuesOfAnySizeArriveAtTheirNumber) {
  const auto mesh = distribute(world, test::mixed_row(7));
  const auto order = natural_cell_order(mesh);
  std::vector<std::uint8_t> bytes;
  std::vector<GlobalIndex> longs;
  for (const auto& cells : mesh.cells)
    for (const auto id : cells.global_ids) {
      bytes.push_back(static_cast<std::uint8_t>(id + 3));
      for (int i = 0; i < 5; ++i) longs.push_back((id << 40) + i);
    }
  const auto byte_slice = order.to_slices<std::uint8_t>(bytes);
  const auto long_slice = order.to_slices<GlobalIndex>(longs, 5);
  ASSERT_EQ(byte_slice.size(), order.slice_size());
  for (std::size_t i = 0; i < byte_slice.size(); ++i) {
    const auto number = order.first() + static_cast<GlobalIndex>(i);
    EXPECT_EQ(byte_slice[i], number + 3);
    EXPECT_EQ(long_slice[5 * i + 4], (number << 40) + 4);
  }
  EXPECT_EQ(order.to_owners<std::uint8_t>(byte_slice), bytes);
  EXPECT_EQ(order.to_owners<GlobalIndex>(long_slice, 5), longs);
}

}  // namespace
}  // namespace evert
