#pragma once
#include "evert/contact/rigid_body.hpp"
#include "evert/scene/config.hpp"

#include <mpi.h>

#include <memory>
#include <string>
#include <vector>

namespace evert {

/// Collective. The tables of poses that obstacles have in files, per obstacle; empty for those without.
/// Throws UserError on all ranks where a table is wrong.
[[nodiscard]] std::vector<std::vector<PoseKey>> read_motions(MPI_Comm comm, const SceneConfig& scene);

/// What a scene says of the motion of an obstacle that is at `start` at t = 0, with the `keys` of its file.
[[nodiscard]] std::unique_ptr<RigidMotion> motion_of(const ObstacleConfig& obstacle, const RigidState& start,
                                                     const std::vector<PoseKey>& keys);

/// A body with the mass that the scene says, that is at `start` at t = 0. Throws UserError where `surface`
/// goes on for ever.
[[nodiscard]] std::unique_ptr<RigidBody> rigid_body_of(const ObstacleConfig& obstacle,
                                                       const ImplicitSurface& surface, RigidState start);

/// What is wrong with the next key of a table: "" where nothing is.
[[nodiscard]] std::string wrong_with(const std::vector<PoseKey>& keys_before, const PoseKey& key);
/// From t, x, y, z and the quaternion w, x, y, z.
[[nodiscard]] PoseKey pose_key(const std::array<double, 8>& row);

}  // namespace evert
