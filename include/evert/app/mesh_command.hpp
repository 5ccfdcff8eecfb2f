#pragma once
#include <ostream>
#include <span>
#include <string>

namespace evert {

/// `evert mesh generate|convert|quality|partition ...`: makes, converts, judges and partitions meshes.
/// `arguments` are those after `evert mesh`; reports go to `out`, which `evert mesh --help` describes. Not
/// collective: for one rank. Returns the exit code 0. Throws UserError for bad usage, bad meshes and files
/// that cannot be written.
int mesh_command(std::span<const std::string> arguments, std::ostream& out);

}  // namespace evert
