#pragma once
#include "evert/math/vec3.hpp"

#include <string>
#include <vector>

namespace evert {

/// Deformation gradients of a file: 9 numbers a line, row by row, apart by spaces, tabs or commas; empty
/// lines and what follows a # do not count. Throws UserError with the line that is wrong.
[[nodiscard]] std::vector<Mat3d> read_deformation_gradients(const std::string& path);

}  // namespace evert
