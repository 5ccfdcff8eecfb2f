#pragma once
#include "evert/core/schema.hpp"
#include "evert/scene/config.hpp"

namespace evert {

/// The shapes with their keys and their place, for a table whose keys stand beside them.
void add_shape_keys(schema::Table<ObstacleConfig>& table);
/// The shapes that have an end, with an edge length.
void add_filled_shapes(schema::Table<MeshConfig>& table);

}  // namespace evert
