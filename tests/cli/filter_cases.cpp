#include "case.hpp"

/// Cases of `filter:`.
namespace evert::cli {
namespace {

/// The cube with a filter for ten times the step that its elements take.
File filtered_scene(const std::vector<Edit>& edits = {}) {
  std::vector<Edit> all{{"petsc:", "filter: {time_step: 0.04}\npetsc:"}};
  all.insert(all.end(), edits.begin(), edits.end());
  return scene(all);
}

Case good(const std::string& name, const std::string& command, const std::vector<std::string>& says = {}) {
  return {.name = name, .command = command, .files = {filtered_scene()}, .exit_code = 0, .says = says};
}

Case bad(const std::string& name, const std::string& setting, const std::vector<std::string>& says) {
  return {.name = name, .command = "run scene.yaml " + setting, .files = {filtered_scene()}, .says = says};
}

const std::vector<Case> cases{
    good("filter_check", "check scene.yaml",
         {"48 of 48 tet4 are filtered for steps of 0.04 s with a safety of 1.25, selection spare_mass, "
          "constraints compliant"}),
    good("filter_check_without_constraints", "check scene.yaml -set filter.constraints=none",
         {"48 of 48 tet4 are filtered", "constraints none"}),
    good("filter_check_of_a_small_step", "check scene.yaml -set filter.time_step=1e-3",
         {"0 of 48 tet4 are filtered"}),
    good("filter_auto_check", "check scene.yaml -set filter.time_step=auto",
         {"auto: nothing is filtered: no step pays", "1.5 times the body's own"}),
    good("filter_auto_check_of_a_fixed_step",
         "check scene.yaml -set filter.time_step=auto -set integrator.time_step=1e-4",
         {"auto: nothing is filtered: the body takes the fixed step by itself"}),
    good("filter_auto_run", "run scene.yaml -set filter.time_step=auto",
         {"filter: auto: nothing is filtered", "finished at t = 0.002 s"}),
    good("filter_run", "run scene.yaml", {"filter: 48 of 48 tet4", "finished at t = 0.002 s"}),
    good("filter_verlet", "run scene.yaml -set integrator.method=verlet -set petsc=null"),
    good("filter_verlet_blended",
         "run scene.yaml -set integrator.method=verlet -set petsc=null "
         "-set bodies.cube.damping.model=blended"),
    good("filter_stability", "stability scene.yaml -o table.csv", {"27 nodes, 48 elements", "at rest:"}),
    good("filter_stability_at_a_deformed_start",
         "stability scene.yaml -set 'bodies.cube.start={kind: flatten_plane, amplitude: 0.5}'",
         {"at rest:", "at t = 0 s: not looked at"}),
    good("filter_paper", "run scene.yaml -set filter.selection=paper -damping_mat_type baij"),
    good("filter_by_another_solver", "run scene.yaml -projection_ksp_type cg -projection_pc_type jacobi"),
    bad("filter_projection_option_without_compliance", "-set filter.constraints=none -projection_ksp_type cg",
        {"-projection_ksp_type: has no effect", "constraints: compliant or paper"}),
    good("filter_paper_constraints", "run scene.yaml -set filter.constraints=paper"),
    bad("filter_projection_of_compliance", "-set filter.projection=shake",
        {"filter.projection", "goes with 'constraints: paper' only"}),
    bad("filter_sweeps_of_compliance", "-set filter.projection_sweeps=1",
        {"filter.projection_sweeps", "goes with 'constraints: paper' only"}),
    bad("filter_too_many_sweeps", "-set filter.constraints=paper -set filter.projection_sweeps=31",
        {"filter.projection_sweeps", "30"}),
    bad("filter_lengths_that_held_nodes_contradict",
        "-set filter.constraints=paper -set obstacles={} "
        "-set 'bodies.cube.mesh={generate: box, size: [1, 1, 1], cells: [1, 2, 2], cell: tet6}' "
        "-set 'constraints=[{body: cube, node_set: x_min, velocity: [[0, 0, 0, 0]]}, "
        "{body: cube, node_set: x_max, velocity: [[0, 50, 0, 0]]}]'",
        {"filter.constraints: 'paper' keeps lengths", "contradict"}),
    good("filter_without_constraints", "run scene.yaml -set filter.constraints=none"),
    good("filter_adaptive", "run scene.yaml -set filter.selection=adaptive -set filter.safety=1.5"),
    good("filter_with_softening_and_stiffening",
         "run scene.yaml -set 'events=[{at: 5e-4, set: bodies.cube.material.youngs_modulus, to: 0}, "
         "{at: 1e-3, set: bodies.cube.material.youngs_modulus, to: 1.5e5}]'"),
    {.name = "filter_restart",
     .before = "run scene.yaml -set checkpoint.every_simulated=1e-3",
     .command = "run scene.yaml -restart out/checkpoint.h5 -set end_time=3e-3",
     .files = {filtered_scene()},
     .exit_code = 0},
    {.name = "filter_restart_with_another",
     .before = "run scene.yaml -set checkpoint.every_simulated=1e-3",
     .command = "run scene.yaml -restart out/checkpoint.h5 -set end_time=3e-3 -set filter.time_step=0.03",
     .files = {filtered_scene()},
     .says = {"checkpoint.h5"}},

    bad("filter_beyond_reach", "-set filter.time_step=1",
        {"filter.time_step: no filter can reach 1 s", "every element of 'cube'", "allowed is less than"}),
    bad("filter_that_an_event_puts_beyond_reach",
        "-set 'events=[{at: 1e-3, set: bodies.cube.material.youngs_modulus, to: 1e9}]'",
        {"filter.time_step: no filter can reach 0.04 s", "every element of 'cube'"}),
    bad("filter_of_no_step", "-set filter.time_step=0", {"filter.time_step", "must be > 0"}),
    bad("filter_of_an_infinite_step", "-set filter.time_step=.inf", {"filter.time_step"}),
    bad("filter_of_a_word", "-set filter.time_step=often", {"filter.time_step", "'often'", "auto"}),
    bad("filter_that_softens_more_than_all", "-set filter.time_step=auto -set filter.most_softened=2",
        {"filter.most_softened", "must be in (0, 1]"}),
    bad("filter_of_a_fixed_step_beyond_reach",
        "-set filter.time_step=auto -set integrator.time_step=1 -set end_time=2",
        {"no filter can reach 1 s", "every element of 'cube'"}),
    bad("filter_without_step", "-set 'filter={safety: 2}'", {"filter", "time_step"}),
    bad("filter_that_is_no_table", "-set filter=on", {"filter"}),
    bad("filter_of_no_safety", "-set filter.safety=0.5", {"filter.safety", "must be >= 1"}),
    bad("filter_of_an_unknown_selection", "-set filter.selection=adaptiv",
        {"filter.selection", "did you mean 'adaptive'?"}),
    bad("filter_of_unknown_constraints", "-set filter.constraints=compliantt",
        {"filter.constraints", "did you mean 'compliant'?"}),
    bad("filter_of_an_unknown_key", "-set filter.timestep=1e-3", {"filter.timestep", "did you mean"}),
    bad("filter_of_smaller_steps_than_made", "-set integrator.time_step=0.05",
        {"integrator.time_step", "must be at most filter.time_step"}),
    bad("filter_of_states_of_rest",
        "-set integrator.method=quasistatic -set obstacles={} "
        "-set 'constraints=[{body: cube, node_set: x_min, fixed: true}]'",
        {"filter: has no effect", "quasistatic"}),
    bad("filter_of_consistent_masses", "-set obstacles=null -set integrator.mass=consistent",
        {"filter: is not possible with 'integrator.mass: consistent'", "'lumped'"}),
    bad("filter_of_explicit_euler",
        "-set integrator.method=explicit_euler -set integrator.time_step=1e-3 -set petsc=null",
        {"filter: is not possible with 'integrator.method: explicit_euler'"}),
    bad("filter_of_hexahedra",
        "-set 'bodies.cube.mesh={generate: box, size: [1, 1, 1], cells: [2, 2, 2], cell: hex8}'",
        {"filter: 'cube' has elements hex8", "tet4"}),
    bad("filter_of_wedges",
        "-set 'bodies.cube.mesh={generate: box, size: [1, 1, 1], cells: [2, 2, 2], cell: wedge6}'",
        {"filter: 'cube' has elements wedge6", "tet4"}),
    bad("filter_of_quadratic_tetrahedra", "-set bodies.cube.order=2",
        {"filter: 'cube' has elements tet10", "tet4"}),
    bad("filter_of_muscle",
        "-set 'bodies.cube.material={model: muscle, youngs_modulus: 1e5, poissons_ratio: 0.3}' "
        "-set 'bodies.cube.fibres={direction: [1, 0, 0]}'",
        {"filter: 'cube' has fibres", "isotropic"}),
    {.name = "filter_of_a_flat_element",
     .command = "run scene.yaml -set filter.time_step=1e-3 -set bodies.cube.mesh.file=cube.msh",
     .files = {scene({{"generate: box, size: [1, 1, 1], cells: [2, 2, 2], cell: tet6", "file: cube.msh"},
                      {"petsc:", "filter: {time_step: 1e-3}\npetsc:"}}),
               gmsh2({{"7 1 1 1", "7 1 1 0"}})},
     .says = {"cube.msh", "volume"}},
};

}  // namespace

std::vector<Case> filter_cases() { return cases; }

}  // namespace evert::cli
