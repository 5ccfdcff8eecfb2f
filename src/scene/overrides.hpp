#pragma once
#include "evert/core/schema.hpp"

#include <span>
#include <string>

/// "-set path=value" from the command line, written into the values of a scene before they are read.
namespace evert {

/// Applies them in order. A path has dots between keys, names of bodies and the like, and indices of lists
/// (constraints.0.fixed). `null` takes a key away. A key that chooses among alternatives (mesh.file,
/// mesh.generate, shape) takes those away that go with another one. Throws UserError for a path that the
/// table does not have, with the nearest one that it has.
void apply_overrides(schema::Value& scene, const schema::TableInfo& table,
                     std::span<const std::string> overrides);

}  // namespace evert
