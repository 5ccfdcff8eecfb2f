#pragma once
#include <ostream>
#include <span>
#include <string>

namespace evert {

/// `evert view run.h5 [-o view.html] [-frames 120] [-max_triangles 100000] [-up y]`: writes a self-contained
/// web page that plays the frames of a run, by default beside the run file. Says what was left out. Not
/// collective: for one rank. Returns the exit code 0. Throws UserError for a file that is no usable run or
/// cannot be written.
int view_command(std::span<const std::string> arguments, std::ostream& out);

}  // namespace evert
