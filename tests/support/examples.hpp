#pragma once
#include "evert/scene/petsc_options.hpp"

#include "tests/support/scenes.hpp"
#include <cstdlib>

namespace evert::test {

/// Collective. examples/`name`/scene.yaml with changes, its PETSc options in force.
inline BuiltScene build_example(const std::string& name, const std::vector<std::string>& overrides) {
  const char* root = std::getenv("EVERT_SOURCE_DIR");
  const auto file = std::string(root == nullptr ? "." : root) + "/examples/" + name + "/scene.yaml";
  auto scene = load_scene(PETSC_COMM_WORLD, file, overrides);
  apply_petsc_block(scene);
  return build_scene(PETSC_COMM_WORLD, scene);
}

}  // namespace evert::test
