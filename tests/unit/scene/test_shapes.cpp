#include "evert/scene/load.hpp"

#include <gtest/gtest.h>

#include "scenes.hpp"

namespace evert {
namespace {

using testing::complaint;
using testing::least_scene;

ObstacleConfig obstacle(const std::string& keys, const std::vector<std::string>& overrides = {}) {
  return parse_scene(least_scene + "obstacles: {it: {" + keys + "}}\n", "folder/scene.yaml", overrides)
      .obstacles[0];
}

std::string wrong(const std::string& keys, const std::vector<std::string>& overrides = {}) {
  return complaint(least_scene + "obstacles: {it: {" + keys + "}}\n", overrides);
}

TEST(Shapes, have_their_keys_and_their_place) {
  const auto gear = obstacle(
      "shape: gear, teeth: 9, root_radius: 0.3, tip_radius: 0.4, width: 0.2, center: [1, 2, 3], "
      "rotate: {axis: [2, 0, 0], angle: 90}, grow: 0.01");
  const auto& shape = std::get<GearShape>(gear.shape.solid);
  EXPECT_EQ(shape.teeth, 9);
  EXPECT_EQ(shape.root_radius, 0.3);
  EXPECT_EQ(shape.tip_radius, 0.4);
  EXPECT_EQ(shape.width, 0.2);
  EXPECT_EQ(gear.shape.center, (Vec3d{1, 2, 3}));
  EXPECT_EQ(gear.shape.rotate->axis, (Vec3d{1, 0, 0}));
  EXPECT_EQ(gear.shape.grow, 0.01);
}

TEST(Shapes, can_be_combined_to_any_depth) {
  const auto cut = obstacle(
      "shape: difference, of: [{shape: box, size: [1, 1, 1]}, {shape: union, of: [{shape: sphere, radius: "
      "0.4}, "
      "{shape: half_space, point: [0, -0.2, 0]}]}]");
  const auto& parts = std::get<DifferenceShape>(cut.shape.solid).of;
  ASSERT_EQ(parts.size(), 2U);
  const auto& inner = std::get<UnionShape>(parts[1].solid).of;
  ASSERT_EQ(inner.size(), 2U);
  EXPECT_EQ(std::get<HalfSpaceShape>(inner[1].solid).point, (Vec3d{0, -0.2, 0}));
}

TEST(Shapes, are_changed_by_overrides) {
  const std::string cut =
      "shape: difference, of: [{shape: box, size: [1, 1, 1]}, {shape: sphere, radius: 0.4}]";
  const auto changed = obstacle(cut, {"obstacles.it.of.1.radius=0.6", "obstacles.it.center=[0, 1, 0]"});
  EXPECT_EQ(std::get<SphereShape>(std::get<DifferenceShape>(changed.shape.solid).of[1].solid).radius, 0.6);
  EXPECT_EQ(changed.shape.center, (Vec3d{0, 1, 0}));
  EXPECT_NE(wrong(cut, {"obstacles.it.of.1.raduis=0.6"}).find("did you mean 'radius'"), std::string::npos);
}

TEST(Shapes, take_files_from_the_folder_of_the_scene) {
  const auto surface = [](const ObstacleConfig& config) {
    return std::get<MeshShape>(std::get<UnionShape>(config.shape.solid).of[0].solid).surface;
  };
  const std::string keys = "shape: union, of: [{shape: mesh, surface: part.stl}]";
  EXPECT_EQ(surface(obstacle(keys)), "folder/part.stl");
  EXPECT_EQ(surface(obstacle(keys, {"obstacles.it.of.0.surface=other.stl"})), "other.stl");
}

TEST(Shapes, are_refused_where_they_are_written) {
  const std::string at = "scene.yaml:8: obstacles.it";
  EXPECT_EQ(wrong("shape: gear, teeth: 9, root_radius: 0.4, tip_radius: 0.4, width: 0.2"),
            at + ": tip_radius is 0.4, but must be more than root_radius, 0.4");
  EXPECT_EQ(wrong("shape: gear, teeth: 2, root_radius: 0.3, tip_radius: 0.4, width: 0.2"),
            at + ".teeth: '2' is not allowed: must be a whole number from 3 to 10000");
  EXPECT_EQ(wrong("shape: sphere, radius: -1"), at + ".radius: '-1' is not allowed: must be > 0");
  EXPECT_EQ(wrong("shape: box, size: [1, 0, 1]"), at + ".size[1]: '0' is not allowed: must be > 0");
  EXPECT_EQ(wrong("shape: cone, bottom_radius: 0, length: 1"),
            at + ": bottom_radius is 0 and top_radius 0, but must be at least 0, finite, and one of them "
                 "more than 0");
  EXPECT_EQ(wrong("shape: sphere, radius: 1, grow: -1"), at + ": the sphere is empty: no point is inside");
  EXPECT_EQ(wrong("shape: difference, of: [{shape: sphere, radius: 1}, {shape: box, size: [3, 3, 3]}]"),
            at + ": the difference is empty: no point is inside");
  EXPECT_EQ(wrong("shape: union, of: []"), at + ".of: must have at least one part");
  EXPECT_EQ(wrong("shape: union, of: [{shape: sphere, radius: 0}]"),
            at + ".of[0].radius: '0' is not allowed: must be > 0");
  EXPECT_EQ(wrong("shape: half_space, center: [0, 1, 0]"),
            at + ".center: does not go with 'shape: half_space': 'normal' and 'point' place it");
}

}  // namespace
}  // namespace evert
