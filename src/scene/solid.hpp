#pragma once
#include "evert/scene/shape_config.hpp"
#include "evert/shapes/combined.hpp"

#include <map>
#include <set>
#include <string>

/// Shapes of a scene to solids.
namespace evert {

/// Surfaces of triangles by the path of their file.
using Surfaces = std::map<std::string, TriangleSurface>;

/// Adds the paths of the files that the shape and its parts name.
void add_files(const SolidConfig& solid, std::set<std::string>& paths);
[[nodiscard]] bool names_file(const SolidConfig& solid);

/// Reads the files that a shape names and that are not there yet, and checks them. Throws UserError.
void read_surfaces(const SolidConfig& solid, Surfaces& surfaces);

/// The solid in its own frame: grown, but not placed. `surfaces` has the files that it names. Throws
/// UserError for sizes that do not go together, and where nothing is inside.
[[nodiscard]] Solid make_solid(const ShapeConfig& shape, const Surfaces& surfaces);

[[nodiscard]] Mat3d rotation_of(const RotationConfig& rotate);

}  // namespace evert
