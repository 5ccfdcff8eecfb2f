#pragma once
#include "evert/io/run_reader.hpp"

#include <filesystem>

/// One frame of a run for other programs. Not collective.
namespace evert {

/// The deformed mesh with all fields of the frame, as VTU with inline base64: what every VTK and ParaView
/// reads. Throws UserError when the frame does not exist or the file cannot be written.
void export_vtu(const RunReader& run, std::size_t frame, const std::filesystem::path& path);

/// The deformed surface as triangles in binary PLY, seen counter-clockwise from outside; vertices carry the
/// velocity and the smallest stretch around them where the frame has them. Throws as export_vtu does.
void export_surface_ply(const RunReader& run, std::size_t frame, const std::filesystem::path& path);

}  // namespace evert
