#include "evert/io/hdf5_file.hpp"

#include <gtest/gtest.h>

#include "scratch.hpp"

namespace evert {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

template <class T>
void expect_back(Hdf5File& file, const T& value) {
  file.set_attribute("/", "value", value);
  EXPECT_EQ(file.attribute<T>("/", "value"), value);
}

TEST(Hdf5File, AttributesComeBack) {
  const test::Scratch scratch;
  auto file = Hdf5File::create(world, scratch / "file.h5");
  expect_back(file, 0.1);
  expect_back(file, std::int64_t{-1} << 62);
  expect_back(file, std::string("text with µ"));
  expect_back(file, std::string());
  expect_back(file, std::vector<double>{1, 2, 3});
  expect_back(file, std::vector<double>{});
  expect_back(file, std::vector<std::int64_t>{4, 5});
  expect_back(file, std::vector<std::string>{"one", "", "three"});
  expect_back(file, std::vector<std::string>{});
}

TEST(Hdf5File, TablesComeBackRowByRow) {
  const test::Scratch scratch;
  const auto rank = rank_of(world);
  const auto size = size_of(world);
  {
    auto file = Hdf5File::create(world, scratch / "file.h5");
    // The last rank has none.
    const GlobalIndex mine = rank + 1 < size || size == 1 ? 2 : 0;
    const GlobalIndex all = size == 1 ? 2 : 2 * (size - 1);
    const std::vector<double> values(static_cast<std::size_t>(3 * mine), rank);
    file.write<double>("/table", {all, 3}, {2 * rank, mine}, values);
  }
  const auto file = Hdf5File::open(world, scratch / "file.h5", Hdf5File::Access::read);
  const auto shape = file.shape_of("/table");
  EXPECT_EQ(shape.width, 3);
  const auto values = file.read<double>("/table", {0, shape.rows});
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], static_cast<double>(i / 6));
}

TEST(Hdf5File, WhatIsNotThereIsAnErrorOnEveryRank) {
  const test::Scratch scratch;
  EXPECT_THROW(Hdf5File::open(world, scratch / "none.h5", Hdf5File::Access::read), UserError);
  auto file = Hdf5File::create(world, scratch / "file.h5");
  file.write<double>("/table", {1, 1}, {}, {});
  EXPECT_TRUE(file.contains("/table"));
  EXPECT_FALSE(file.contains("/group/table"));
  EXPECT_THROW(static_cast<void>(file.shape_of("/none")), UserError);
  EXPECT_THROW(static_cast<void>(file.attribute<double>("/table", "none")), UserError);
  EXPECT_THROW(static_cast<void>(file.read<double>("/table", {0, 2})), UserError);
  EXPECT_THROW(static_cast<void>(file.read<double>("/table", {-1, 1})), UserError);
  EXPECT_THROW(file.overwrite<double>("/table", {2, 1}, {}, {}), UserError);
}

TEST(Hdf5File, AnErrorOnOneRankIsThrownOnAll) {
  const test::Scratch scratch;
  auto file = Hdf5File::create(world, scratch / "file.h5");
  file.write<double>("/table", {4, 1}, {}, {});
  const GlobalIndex count = rank_of(world) == size_of(world) - 1 ? 5 : 1;
  EXPECT_EQ(test::user_error_of([&] {
              static_cast<void>(file.read<double>("/table", {0, count}));
            }),
            "cannot read '" + (scratch / "file.h5") + "': table '/table' has only 4 rows");
}

TEST(Hdf5File, PrintsNothingWhenACallFails) {
  testing::internal::CaptureStderr();
  EXPECT_THROW(Hdf5File::open(world, "/nowhere/file.h5", Hdf5File::Access::read), UserError);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace evert
