#include "case.hpp"

/// Cases of generated meshes with bad elements.
namespace evert::cli {
namespace {

/// `check` of the good scene with this mesh.
Case bad(const std::string& name, const std::string& mesh, const std::vector<std::string>& says) {
  return {.name = name,
          .command = "check scene.yaml -set 'bodies.cube.mesh=" + mesh + "'",
          .files = {scene()},
          .says = says};
}

}  // namespace

std::vector<Case> bad_mesh_cases() {
  return {
      {.name = "mesh_generate_cut_cube",
       .command = "mesh generate cut_cube -snap 0.2 -normal 0,0.3,1 -o cut.msh",
       .exit_code = 0,
       .says = {"wrote cut.msh"},
       .ranks = {1}},
      bad("cut_cube_that_is_not_cut", "{generate: cut_cube, through: [0, 0, 9]}",
          {"bodies.cube.mesh: the plane cuts nothing: everything is on one side of it"}),
      bad("cut_cube_of_much_snap", "{generate: cut_cube, snap: 0.7}",
          {"bodies.cube.mesh.snap", "must be in [0, 0.5]"}),
      bad("sliver_ball_without_room", "{generate: sliver_ball, radius: 1, edge_length: 0.3, thinnest: 0.1}",
          {"bodies.cube.mesh: slivers are 0.01 of all", "have room"}),
      bad("wedge_stack_of_no_layer", "{generate: wedge_stack, layers: 0}",
          {"bodies.cube.mesh.layers", "must be a whole number from 1"}),
  };
}

}  // namespace evert::cli
