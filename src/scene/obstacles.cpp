#include "obstacles.hpp"

#include "evert/core/collective.hpp"

#include "motion.hpp"
#include "solid.hpp"
#include <set>
#include <string>

namespace evert {
namespace {

/// Rank 0's surface on every rank.
void broadcast(MPI_Comm comm, TriangleSurface& surface) {
  std::array<std::int64_t, 2> sizes{static_cast<std::int64_t>(surface.points.size()),
                                    static_cast<std::int64_t>(surface.triangles.size())};
  MPI_Bcast(sizes.data(), 2, MPI_INT64_T, 0, comm);
  surface.points.resize(static_cast<std::size_t>(sizes[0]));
  surface.triangles.resize(static_cast<std::size_t>(sizes[1]));
  // whole points and triangles, so that the counts fit into an int
  MPI_Datatype point = MPI_DATATYPE_NULL, triangle = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(3, MPI_DOUBLE, &point);
  MPI_Type_contiguous(3, MPI_INT32_T, &triangle);
  MPI_Type_commit(&point);
  MPI_Type_commit(&triangle);
  MPI_Bcast(surface.points.data(), static_cast<int>(sizes[0]), point, 0, comm);
  MPI_Bcast(surface.triangles.data(), static_cast<int>(sizes[1]), triangle, 0, comm);
  MPI_Type_free(&point);
  MPI_Type_free(&triangle);
}

/// Every file that an obstacle names. Collective.
Surfaces read_obstacle_surfaces(MPI_Comm comm, const SceneConfig& scene) {
  Surfaces surfaces;
  on_root(comm, [&] {
    for (const auto& obstacle : scene.obstacles) read_surfaces(obstacle.shape.solid, surfaces);
  });
  std::set<std::string> paths;
  for (const auto& obstacle : scene.obstacles) add_files(obstacle.shape.solid, paths);
  for (const auto& path : paths) broadcast(comm, surfaces[path]);
  return surfaces;
}

/// `keys` of the file of its motion, where that has one.
std::unique_ptr<Obstacle> obstacle_of(const ObstacleConfig& config, const Surfaces& surfaces,
                                      const std::vector<PoseKey>& keys) {
  const auto& shape = config.shape;
  RigidState start{.origin = shape.center};
  if (shape.rotate) start.rotation = rotation_of(*shape.rotate);
  auto solid = make_solid(shape, surfaces);
  if (config.mass || config.density) {
    auto body = rigid_body_of(config, *solid, start);
    return std::make_unique<Obstacle>(config.name, config.friction, std::move(solid), std::move(body));
  }
  auto obstacle = std::make_unique<Obstacle>(config.name, config.friction, std::move(solid),
                                             motion_of(config, start, keys));
  if (config.until) obstacle->remove_after(*config.until);
  return obstacle;
}

}  // namespace

std::vector<std::unique_ptr<Obstacle>> make_obstacles(MPI_Comm comm, const SceneConfig& scene) {
  const auto keys = read_motions(comm, scene);
  const auto surfaces = read_obstacle_surfaces(comm, scene);
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  on_every_rank(comm, [&] {
    for (std::size_t o = 0; o < scene.obstacles.size(); ++o) {
      const auto& config = scene.obstacles[o];
      try {
        obstacles.push_back(obstacle_of(config, surfaces, keys[o]));
      } catch (const UserError& error) {
        throw UserError("obstacles." + config.name + ": " + error.what());
      }
    }
  });
  return obstacles;
}

}  // namespace evert
