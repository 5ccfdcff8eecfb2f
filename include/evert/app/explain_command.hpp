#pragma once
#include <ostream>
#include <span>
#include <string>

namespace evert {

/// `evert explain [key] [-markdown]`: prints the scene reference, or what it says about a key. Not
/// collective: for one rank. Returns the exit code 0. Throws UserError for an unknown key or option.
int explain_command(std::span<const std::string> arguments, std::ostream& out);

}  // namespace evert
