#pragma once
#include "evert/core/error.hpp"
#include "evert/scene/load.hpp"

#include <string>
#include <vector>

/// Scenes for the tests of the scene layer.
namespace evert::testing {

/// Names every feature, one line a key: a test that breaks a line knows its number.
inline const std::string full_scene = R"(name: full
end_time: 2
gravity: [0, -9.81, 0]
output:
  directory: runs/elsewhere
  frames_per_second: 30
  fields: [velocity, rank]
  energy_log: 0
bodies:
  torus:
    mesh: {generate: torus, major_radius: 0.5, minor_radius: 0.2, edge_length: 0.1}
    transform: {fit: 2, scale: 0.5, rotate: {axis: [0, 0, 3], angle: 90}, translate: [0, 1, 0]}
    density: 1000
    velocity: [0, -1, 0]
    spin: [0.5, 0.25, 0]
    start: {kind: scramble, amplitude: 0.5, axis: [1, 0, 0], seed: 7}
    material:
      model: neo_hookean
      youngs_modulus: 1.0e5
      poissons_ratio: 0.45
      compression_limit: 0.3
      extension: clamp
    damping: {model: rotated, stiffness_proportional: 1.0e-3}
    groups:
      tendon:
        density: 1200
        material: {model: st_venant_kirchhoff, youngs_modulus: 1e6, poissons_ratio: -0.2}
        damping: {model: none}
  box:
    mesh: {generate: box, min: [0, 0, 0], max: [1, 2, 3], cells: [1, 2, 3], cell: tet5}
    density: 2
    material: {model: rotated_linear, youngs_modulus: 0, poissons_ratio: 0}
    damping: {model: objective, alpha: 3, beta: 4}
obstacles:
  ground: {shape: half_space, normal: [0, 2, 0], point: [0, -1, 0], friction: 0.4, velocity: [0, 0, 1]}
  ball: {shape: sphere, center: [1, 2, 3], radius: 4}
constraints:
  - {body: box, node_set: x_min, fixed: true}
  - {body: box, box: {min: [0, 0, 0], max: [1, 1, 1]}, velocity: [0, 1, 0], axes: [true, false, true]}
  - {body: torus, sphere: {center: [0, 1, 0], radius: 0.1}, velocity: [[0, 0, 0, 0], [1, 0, 0.5, 0]], from: 0.5, until: 1}
events:
  - {at: 0.5, set: bodies.torus.material.youngs_modulus, to: 2.0e5}
integrator: {method: newmark, time_step: 1e-4, safety: 0.5, max_strain_increment: 0.05}
checkpoint: {every_simulated: 0.5, every_wall: 600}
petsc: {damping_ksp_rtol: 1.0e-6, damping_ksp_type: cg}
)";

/// The least that a scene can say.
inline const std::string least_scene = R"(name: least
end_time: 1
bodies:
  ball:
    mesh: {generate: ball, radius: 1, edge_length: 0.5}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.3}
)";

/// `text` with the first `old_part` replaced; fails loudly when there is none.
inline std::string changed(std::string text, const std::string& old_part, const std::string& new_part) {
  const auto at = text.find(old_part);
  if (at == std::string::npos) throw std::logic_error("the scene has no '" + old_part + "'");
  return text.replace(at, old_part.size(), new_part);
}

/// What is wrong with the scene, or "nothing".
inline std::string complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    static_cast<void>(parse_scene(text, "scene.yaml", overrides));
    return "nothing";
  } catch (const UserError& error) {
    return error.what();
  }
}

}  // namespace evert::testing
