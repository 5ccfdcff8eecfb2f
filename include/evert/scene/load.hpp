#pragma once
#include "evert/scene/config.hpp"

#include <mpi.h>

#include <span>
#include <string>
#include <string_view>

/// From the text of a scene to its values.
namespace evert {

/// Collective. Rank 0 reads the file, every rank parses the same text, so that every rank has the same scene
/// or throws the same error. `overrides` are "path=value", the value written as in the scene; they are
/// applied in order before anything is checked. Throws UserError: one sentence with file:line (or the
/// override) and key path.
[[nodiscard]] SceneConfig load_scene(MPI_Comm comm, const std::string& path,
                                     std::span<const std::string> overrides = {});

/// Not collective. The same from text in memory; `file` names it in messages.
[[nodiscard]] SceneConfig parse_scene(std::string_view text, const std::string& file,
                                      std::span<const std::string> overrides = {});

/// Writes the value of a timed event into the scene; the materials to be set anew are then read from there.
void apply_event(SceneConfig& scene, const EventConfig& event);

}  // namespace evert
