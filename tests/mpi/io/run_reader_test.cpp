#include "evert/io/run_reader.hpp"

#include "evert/io/frame_writer.hpp"

#include <gtest/gtest.h>

#include "../mesh/test_meshes.hpp"
#include "scratch.hpp"

namespace evert {
namespace {

/// A run of one frame, changed by `change` before it is read.
template <class Change>
std::string error_after(Change&& change) {
  const test::Scratch scratch;
  const auto path = scratch / "run.h5";
  {
    const auto mesh = distribute(MPI_COMM_SELF, test::mixed_row(3));
    NodeField field(mesh);
    FrameWriter writer(mesh, path, {});
    writer.write({0, 0, field, field, [](std::size_t, std::span<double>) {}});
  }
  {
    auto file = Hdf5File::open(MPI_COMM_SELF, path, Hdf5File::Access::write);
    change(file);
  }
  const auto message = test::user_error_of([&] {
    const RunReader run(path);
    static_cast<void>(run.mesh());
    static_cast<void>(run.positions(0));
  });
  const std::string before = "' is not a usable run file: ";
  const auto reason = message.find(before);
  return reason == std::string::npos ? message : message.substr(reason + before.size());
}

TEST(RunReader, ReadsAWholeFile) {
  EXPECT_EQ(error_after([](Hdf5File&) {}), "");
}

TEST(RunReader, FindsWhatIsWrong) {
  EXPECT_EQ(
      error_after([](Hdf5File& file) { file.set_attribute("/", "format", std::string("evert checkpoint")); }),
      "it is an evert checkpoint file");
  EXPECT_EQ(error_after([](Hdf5File& file) { file.set_attribute("/", "format_version", std::int64_t{2}); }),
            "its format has version 2, this evert reads version 1");
  EXPECT_EQ(error_after([](Hdf5File& file) {
              const std::vector<std::int64_t> wild{0, 1, 2, 1000};
              file.overwrite<std::int64_t>("/mesh/cells/tet4", {1, 4}, {0, 1}, wild);
            }),
            "a cell has a node that does not exist");
  EXPECT_EQ(error_after([](Hdf5File& file) {
              const std::vector<std::int32_t> wild{0, 0, -1, 0, 0};
              file.overwrite<std::int32_t>("/mesh/region", {5, 1}, {0, 5}, wild);
            }),
            "a cell lies in no region");
  EXPECT_EQ(error_after([](Hdf5File& file) {
              file.remove("/frames/00000000/positions");
              file.write<double>("/frames/00000000/positions", {2, 3}, {0, 2}, std::vector<double>(6));
            }),
            "'/frames/00000000/positions' does not have three values for every node");
  EXPECT_NE(error_after([](Hdf5File& file) { file.remove("/mesh/rest_positions"); }), "");
  EXPECT_NE(error_after([](Hdf5File& file) { file.remove("/frames"); }), "");
}

TEST(RunReader, RefusesOtherFiles) {
  const test::Scratch scratch;
  std::ofstream(scratch / "text.h5") << "not a run";
  { auto file = Hdf5File::create(MPI_COMM_SELF, scratch / "other.h5"); }
  EXPECT_NE(test::user_error_of([&] { RunReader(scratch / "text.h5"); }), "");
  EXPECT_NE(test::user_error_of([&] { RunReader(scratch / "missing.h5"); }), "");
  EXPECT_EQ(test::user_error_of([&] { RunReader(scratch / "other.h5"); }),
            "'" + (scratch / "other.h5") + "' is not a usable run file: it was not written by evert");
}

}  // namespace
}  // namespace evert
