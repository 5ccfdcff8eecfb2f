#include "case.hpp"

/// Cases of the shapes of obstacles and of generated meshes.
namespace evert::cli {
namespace {

/// The corners of a block of 2 m × 1 m × 2 m, its top at y = 0, as OFF; `faces` are its triangles.
std::string block(const std::string& faces, int count) {
  return "OFF\n8 " + std::to_string(count) +
         " 0\n-1 -1 -1\n-1 -1 1\n-1 0 -1\n-1 0 1\n1 -1 -1\n1 -1 1\n1 0 -1\n1 0 1\n" + faces;
}

const std::string sides =
    "3 0 1 3\n3 0 3 2\n3 4 6 7\n3 4 7 5\n3 0 4 5\n3 0 5 1\n3 0 2 6\n3 0 6 4\n3 1 5 7\n3 1 7 3\n";
const std::string lid = "3 2 3 7\n3 2 7 6\n";
/// As the lid, its middle pulled down through the bottom.
const std::string pulled_lid = "3 2 3 8\n3 3 7 8\n3 7 6 8\n3 6 2 8\n";

std::string pulled_block() {
  auto text = block(sides + pulled_lid, 14);
  text.replace(text.find("8 14"), 4, "9 14");
  return text.insert(text.find("3 0 1 3"), "0 -2 0\n");
}

/// The good scene on this obstacle.
File on(const std::string& keys) {
  return scene({{"shape: half_space, normal: [0, 1, 0], point: [0, -1, 0], friction: 0.4", keys}});
}

Case good_obstacle(const std::string& name, const std::string& keys) {
  return {.name = name, .files = {on(keys), {"block.off", block(sides + lid, 12)}}, .exit_code = 0};
}

Case bad_obstacle(const std::string& name, const std::string& keys, const std::vector<std::string>& says,
                  const std::vector<File>& files = {}) {
  Case bad{.name = name, .files = {on(keys)}, .says = says};
  bad.files.insert(bad.files.end(), files.begin(), files.end());
  return bad;
}

const std::string from_file = "shape: mesh, surface: block.off";

}  // namespace

std::vector<Case> shape_cases() {
  return {
      good_obstacle("on_a_box", "shape: box, size: [4, 1, 4], center: [0, -1.5, 0]"),
      good_obstacle("on_a_thin_plate", "shape: box, size: [4, 1e-3, 4], center: [0, -1, 0]"),
      good_obstacle("on_a_gear",
                    "shape: gear, teeth: 8, root_radius: 0.6, tip_radius: 0.8, width: 2, center: [0, -1.8, "
                    "0], rotate: {axis: [1, 0, 0], angle: 90}"),
      good_obstacle("on_a_mesh", from_file + ", center: [0, -1, 0]"),
      good_obstacle("on_a_difference",
                    "shape: difference, of: [{shape: mesh, surface: block.off}, {shape: sphere, "
                    "radius: 0.5}], center: [0, -1, 0]"),
      {.name = "mesh_generate_figure",
       .command = "mesh generate figure -height 1.8 -edge_length 0.05 -o figure.msh",
       .exit_code = 0,
       .says = {"wrote figure.msh"},
       .ranks = {1}},
      {.name = "mesh_generate_from_surface",
       .command = "mesh generate mesh -surface block.off -edge_length 0.25 -o block.msh",
       .files = {{"block.off", block(sides + lid, 12)}},
       .exit_code = 0,
       .says = {"wrote block.msh"},
       .ranks = {1}},
      {.name = "mesh_generate_empty",
       .command =
           "mesh generate intersection -of '[{shape: sphere, radius: 1}, {shape: sphere, radius: 1, center: "
           "[3, 0, 0]}]' -edge_length 0.1 -o no.msh",
       .says = {"the intersection is empty: no point is inside"},
       .ranks = {1}},
      bad_obstacle("zero_size_shape", "shape: box, size: [1, 0, 1]",
                   {"scene.yaml:", "ground.size[1]", "must be > 0"}),
      bad_obstacle("negative_radius", "shape: capsule, radius: -0.1, length: 1",
                   {"ground.radius", "must be > 0"}),
      bad_obstacle("blunt_gear", "shape: gear, teeth: 8, root_radius: 0.5, tip_radius: 0.4, width: 1",
                   {"tip_radius is 0.4, but must be more than root_radius, 0.5"}),
      bad_obstacle("two_teeth", "shape: gear, teeth: 2, root_radius: 0.3, tip_radius: 0.4, width: 1",
                   {"ground.teeth", "must be a whole number from 3"}),
      bad_obstacle("empty_difference",
                   "shape: difference, of: [{shape: sphere, radius: 1}, {shape: box, size: [3, 3, 3]}]",
                   {"scene.yaml:", "the difference is empty: no point is inside"}),
      bad_obstacle(
          "empty_difference_of_a_mesh",
          "shape: difference, of: [{shape: mesh, surface: block.off}, {shape: box, size: [9, 9, 9]}]",
          {"obstacles.ground", "the difference is empty: no point is inside"},
          {{"block.off", block(sides + lid, 12)}}),
      bad_obstacle("no_surface_file", from_file, {"block.off: there is no such file"}),
      bad_obstacle("open_surface", from_file,
                   {"block.off: the surface is open: the edge from (-1, 0, -1) to (-1, 0, 1) of triangle 2"},
                   {{"block.off", block(sides, 10)}}),
      bad_obstacle("self_intersecting_surface", from_file,
                   {"block.off: triangles 5 and ", "cut each other: the surface must not intersect itself"},
                   {{"block.off", pulled_block()}}),
      bad_obstacle("surface_cut_off", from_file, {"block.off"},
                   {cut({"block.off", block(sides + lid, 12)}, 6)}),
  };
}

}  // namespace evert::cli
