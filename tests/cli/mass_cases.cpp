#include "case.hpp"

/// Cases of `integrator: {mass: consistent}`.
namespace evert::cli {
namespace {

const std::string ground =
    "obstacles:\n  ground: {shape: half_space, normal: [0, 1, 0], point: [0, -1, 0], friction: 0.4}\n";

/// The cube without obstacle.
File consistent_scene(const std::vector<Edit>& edits = {}) {
  std::vector<Edit> all{{ground, "integrator: {mass: consistent}\n"}};
  all.insert(all.end(), edits.begin(), edits.end());
  return scene(all);
}

const Edit undamped{"    damping: {model: rotated, stiffness_proportional: 0.01}\n", ""};

/// Three hexahedra in a row. A corner of the last is pushed along its diagonal: the volume is positive at the
/// Gauss points, and not everywhere.
const File folded_hexes{"hexes.vtk", R"(# vtk DataFile Version 3.0
hexes
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 16 double
0 0 0  1 0 0  2 0 0  2.52 0.48 0.48
0 1 0  1 1 0  2 1 0  3 1 0
0 0 1  1 0 1  2 0 1  3 0 1
0 1 1  1 1 1  2 1 1  3 1 1
CELLS 3 27
8 0 1 5 4 8 9 13 12
8 1 2 6 5 9 10 14 13
8 2 3 7 6 10 11 15 14
CELL_TYPES 3
12
12
12
)"};

File folded_scene(const std::string& integrator) {
  auto with_mesh = scene_with_mesh("hexes.vtk");
  const auto at = with_mesh.content.find(ground);
  with_mesh.content.replace(at, ground.size(), integrator);
  return with_mesh;
}

Case bad_consistent(const std::string& name, const std::string& command,
                    const std::vector<std::string>& says) {
  return {.name = name, .command = command, .files = {consistent_scene()}, .says = says};
}

const std::vector<Case> cases{
    {.name = "consistent", .files = {consistent_scene()}, .exit_code = 0},
    {.name = "consistent_check",
     .command = "check scene.yaml",
     .files = {consistent_scene()},
     .exit_code = 0,
     .says = {"kg in all, consistent"}},
    {.name = "consistent_quadratic_without_damping",
     .command = "run scene.yaml -damping_ksp_converged_reason",
     .files = {consistent_scene({undamped, {"    density: 1000\n", "    density: 1000\n    order: 2\n"}})},
     .exit_code = 0,
     .says = {"Linear damping_ solve converged"}},
    {.name = "consistent_gamg",
     .command = "run scene.yaml -damping_mat_type aij -damping_pc_type gamg",
     .files = {consistent_scene()},
     .exit_code = 0},
    {.name = "consistent_sbaij_without_damping",
     .command = "run scene.yaml -damping_mat_type sbaij",
     .files = {consistent_scene({undamped})},
     .exit_code = 0},
    {.name = "consistent_restart",
     .before = "run scene.yaml -set checkpoint.every_simulated=1e-3",
     .command = "run scene.yaml --restart out/checkpoint.h5 -set end_time=3e-3",
     .files = {consistent_scene()},
     .exit_code = 0},
    bad_consistent("mass_unknown", "run scene.yaml -set integrator.mass=consistant",
                   {"integrator.mass", "lumped", "did you mean 'consistent'?"}),
    bad_consistent("mass_of_numbers", "run scene.yaml -set integrator.mass=1", {"integrator.mass", "lumped"}),
    bad_consistent("mass_of_quasistatic", "run scene.yaml -set integrator.method=quasistatic",
                   {"integrator.mass", "has no effect", "newmark"}),
    {.name = "consistent_with_obstacles",
     .command = "run scene.yaml -set integrator.mass=consistent",
     .files = {scene()},
     .says = {"scene.yaml", "obstacles", "'integrator.mass: consistent'", "'lumped'"}},
    {.name = "folded_lumped",
     .files = {folded_scene("integrator: {mass: lumped}\n"), folded_hexes},
     .exit_code = 0},
    {.name = "folded_consistent",
     .files = {folded_scene("integrator: {mass: consistent}\n"), folded_hexes},
     .says = {"hex8 cell 2 is folded", "'integrator.mass: consistent'", "'lumped'"}},
};

}  // namespace

std::vector<Case> mass_cases() { return cases; }

}  // namespace evert::cli
