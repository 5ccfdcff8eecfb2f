#pragma once
#include "evert/core/value.hpp"
#include "evert/scene/config.hpp"

namespace evert {

/// Throws UserError for what has no state of rest, or no place in a search for one, in a quasistatic scene
/// whose references are resolved. `root` is the scene as written.
void require_rest(const SceneConfig& scene, const schema::Value& root);

}  // namespace evert
