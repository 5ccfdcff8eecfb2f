#pragma once
#include "evert/contact/obstacle.hpp"
#include "evert/scene/config.hpp"

#include <mpi.h>

#include <memory>
#include <vector>

namespace evert {

/// The obstacles of a scene, on every rank; rank 0 reads the files that they name. Collective. Throws
/// UserError on all ranks.
[[nodiscard]] std::vector<std::unique_ptr<Obstacle>> make_obstacles(MPI_Comm comm, const SceneConfig& scene);

}  // namespace evert
