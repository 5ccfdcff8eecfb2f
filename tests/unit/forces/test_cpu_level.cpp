#include "evert/core/error.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"
#include <cstdlib>
#include <optional>

namespace evert::test {
namespace {

/// Sets EVERT_CPU_LEVEL for the lifetime of the object.
class AskFor {
 public:
  explicit AskFor(const std::string& level) {
    if (const char* value = std::getenv(name)) before_ = value;
    setenv(name, level.c_str(), 1);
  }
  AskFor(const AskFor&) = delete;
  AskFor& operator=(const AskFor&) = delete;
  ~AskFor() { before_ ? setenv(name, before_->c_str(), 1) : unsetenv(name); }

 private:
  static constexpr const char* name = "EVERT_CPU_LEVEL";
  std::optional<std::string> before_;
};

std::string message_for(const std::string& level) {
  const AskFor asked(level);
  const Body body = box(CellType::tet4, 1, 1, 1);
  try {
    static_cast<void>(
        make_elastic_block(body.elastic_cells(), body.rest, RotatedLinear{.lame = soft}, no_damping));
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(CpuLevel, TheEnvironmentChooses) {
  for (const auto& level : supported_levels()) {
    const AskFor asked{std::string(level.name)};
    EXPECT_EQ(kernels::chosen_cpu_level().name, level.name);
    EXPECT_EQ(message_for(std::string(level.name)), "");
  }
}

TEST(CpuLevel, WithoutAWishTheWidestIsTaken) {
  unsetenv("EVERT_CPU_LEVEL");
  EXPECT_EQ(kernels::chosen_cpu_level().name, supported_levels().back().name);
}

TEST(CpuLevel, AnUnknownOneIsAnErrorOfTheUser) {
  for (const char* wrong : {"v1", "avx2", "", "V3"}) {
    const std::string message = message_for(wrong);
    EXPECT_NE(message.find("EVERT_CPU_LEVEL is '" + std::string(wrong) + "'"), std::string::npos) << message;
    EXPECT_NE(message.find(std::string(supported_levels().front().name)), std::string::npos) << message;
  }
}

TEST(CpuLevel, OneThatThisCpuLacksIsAnErrorOfTheUser) {
  for (const auto& level : kernels::cpu_levels()) {
    if (level.supported) continue;
    EXPECT_NE(message_for(std::string(level.name)).find("allowed on this CPU"), std::string::npos);
  }
}

TEST(CpuLevel, LanesGrowWithTheLevel) {
  int before = 0;
  for (const auto& level : supported_levels()) {
    const int lanes = level.find(CellType::tet4, NeoHookean{}, DampingModel::rotated).lanes;
    EXPECT_GT(lanes, before);
    before = lanes;
  }
}

TEST(MakeElasticBlock, NoCellsMakeAnEmptyBlock) {
  const auto block =
      make_elastic_block({CellType::tet4, {}, 0, 1000}, {}, NeoHookean{.lame = soft}, rotated_damping);
  double slack = 0;
  EXPECT_EQ(block->cells(), 0);
  EXPECT_EQ(block->energy(&slack), 0);
  EXPECT_EQ(block->inverted_points(&slack), 0);
  EXPECT_EQ(block->stable_step(&slack).undamped, std::numeric_limits<double>::infinity());
  EXPECT_EQ(block->max_strain_rate(&slack, &slack), 0);
}

}  // namespace
}  // namespace evert::test
