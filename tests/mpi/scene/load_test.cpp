#include "evert/scene/load.hpp"

#include "evert/core/collective.hpp"

#include <gtest/gtest.h>
#include <mpi.h>

#include <filesystem>
#include <fstream>

/// Every rank gets the same scene, or the same error.
namespace evert {
namespace {

constexpr auto scene_text = R"(name: shared
end_time: 1
bodies:
  ball:
    mesh: {generate: ball, radius: 1, edge_length: 0.5}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.3}
)";

/// A file that rank 0 alone can see under this name.
class SharedScene : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = std::filesystem::temp_directory_path() / "evert_scene_mpi.yaml";
    if (rank_of(MPI_COMM_WORLD) == 0) std::ofstream(path_) << scene_text;
    MPI_Barrier(MPI_COMM_WORLD);
  }
  void TearDown() override {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank_of(MPI_COMM_WORLD) == 0) std::filesystem::remove(path_);
  }

  /// Rank 0 knows the right path, the others a wrong one.
  [[nodiscard]] std::string path_of_rank_0() const {
    return rank_of(MPI_COMM_WORLD) == 0 ? path_.string() : "/nowhere.yaml";
  }

  static void expect_same_on_all_ranks(const std::string& text) {
    auto first = text;
    int length = static_cast<int>(first.size());
    MPI_Bcast(&length, 1, MPI_INT, 0, MPI_COMM_WORLD);
    first.resize(static_cast<std::size_t>(length));
    MPI_Bcast(first.data(), length, MPI_CHAR, 0, MPI_COMM_WORLD);
    EXPECT_EQ(text, first);
  }

  static std::string complaint(const std::string& path, const std::vector<std::string>& overrides) {
    try {
      static_cast<void>(load_scene(MPI_COMM_WORLD, path, overrides));
      return "nothing";
    } catch (const UserError& error) {
      return error.what();
    }
  }

  std::filesystem::path path_;
};

TEST_F(SharedScene, is_read_by_rank_0_alone) {
  const auto scene = load_scene(MPI_COMM_WORLD, path_of_rank_0(), {});
  EXPECT_EQ(scene.bodies.size(), 1U);
  expect_same_on_all_ranks(scene.text);
}

TEST_F(SharedScene, fails_alike_on_all_ranks) {
  for (const auto& overrides :
       std::vector<std::vector<std::string>>{{"end_time=-1"}, {"end_tim=1"}, {"end_time=[1"}}) {
    const auto message = complaint(path_.string(), overrides);
    EXPECT_TRUE(message.starts_with("-set ")) << message;
    expect_same_on_all_ranks(message);
  }
}

TEST_F(SharedScene, that_is_missing_fails_alike_on_all_ranks) {
  const auto message = complaint("/nowhere.yaml", {});
  EXPECT_EQ(message, "/nowhere.yaml: there is no such file");
  expect_same_on_all_ranks(message);
}

}  // namespace
}  // namespace evert
