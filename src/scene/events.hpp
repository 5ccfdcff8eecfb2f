#pragma once
#include "evert/core/value.hpp"
#include "evert/scene/config.hpp"

namespace evert {

/// Finds what every event of `scene` sets and reads its value by the type of that key: the same ranges and
/// messages as in the scene itself. `root` holds the values that `scene` was read from. Sorts the events by
/// time. Throws UserError.
void resolve_events(SceneConfig& scene, const schema::Value& root);

}  // namespace evert
