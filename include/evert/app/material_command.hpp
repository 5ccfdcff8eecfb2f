#pragma once
#include <ostream>
#include <span>
#include <string>

namespace evert {

/// `evert material MODEL ...`: drives a material at one point. Prints or plots stress along paths of
/// deformation, or writes the stress of each F of a file. Not collective: for one rank. Returns the exit code
/// 0. Throws UserError for bad usage, a material that cannot be, and files that cannot be read or written.
int material_command(std::span<const std::string> arguments, std::ostream& out);

}  // namespace evert
