#pragma once
#include "evert/scene/build.hpp"

#include <vector>

/// What plastic flow is led to.
namespace evert {

/// Not collective. Reads what `goal` names, for a body that was made as `made`, before it is placed, and is
/// `turned` from there. Throws UserError where the numbers are not those of the body; `path` is where the
/// goal stands in the scene.
[[nodiscard]] BodyGoal read_goal(const GoalConfig& goal, const Mesh& made, const Mat3d& turned,
                                 const std::string& path);

/// Collective; `whole` is of rank 0, but for the ranges of its bodies and what its regions are. The goals of
/// all regions.
[[nodiscard]] std::vector<FlowGoal> flow_goals(const DistributedMesh& mesh, const SceneConfig& scene,
                                               SceneMesh& whole);

}  // namespace evert
