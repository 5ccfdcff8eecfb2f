#pragma once
#include <mpi.h>

#include <string>

namespace evert {

/// Collective. Rank 0's text of a scene file on every rank. Throws UserError for what is no readable scene
/// file.
[[nodiscard]] std::string read_scene_file(MPI_Comm comm, const std::string& path);

}  // namespace evert
