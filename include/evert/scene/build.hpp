#pragma once
#include "evert/scene/config.hpp"
#include "evert/sim/simulation.hpp"

#include <memory>
#include <string>
#include <vector>

/// From the values of a scene to the objects that run.
namespace evert {

/// Where a body's nodes stand among the original node numbers of DistributedMesh.
struct BodyRange {
  std::string name;
  GlobalIndex first_node = 0;
  GlobalIndex end_node = 0;
  Vec3d lower{}, upper{};    ///< bounding box at rest, placed in the world [m]
  Vec3d center_of_volume{};  ///< [m]
};

/// What was read of the goal of a body's plastic flow; nothing of a goal that is a map.
struct BodyGoal {
  std::vector<Vec3d> nodes;         ///< of the body, placed in the world [m]
  std::vector<Mat3d> deformations;  ///< goals of F_p, in the world
  std::vector<GlobalIndex> cells;   ///< whose they are, numbers in the scene's mesh
};

/// All bodies of a scene as one mesh, placed in the world; exists on rank 0 only.
struct SceneMesh {
  Mesh mesh;                      ///< regions: one per body and per group with properties of its own
  std::vector<BodyRange> bodies;  ///< in the order of SceneConfig::bodies
  std::vector<int> region_body;   ///< per region: index of its body
  std::vector<int> region_group;  ///< per region: index into BodyConfig::groups, or −1
  std::vector<BodyGoal> goals;    ///< per body
};

/// Not collective. Reads or generates every body, keeps the named groups, places it in the world and resolves
/// the node selections of the constraints (node set i is that of constraint i). Throws UserError.
[[nodiscard]] SceneMesh build_scene_mesh(const SceneConfig& scene);

/// What a region is made of, from the scene's present values.
[[nodiscard]] ElasticProperties properties_of(const BodyConfig& body, int group);

/// A scene ready to run.
struct BuiltScene {
  std::unique_ptr<Simulation> simulation;
  std::vector<BodyRange> bodies;  ///< on every rank
};

/// Collective. Builds on rank 0, distributes, and makes the simulation at its initial state. Throws UserError
/// on all ranks.
[[nodiscard]] BuiltScene build_scene(MPI_Comm comm, const SceneConfig& scene);

}  // namespace evert
