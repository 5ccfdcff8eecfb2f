#pragma once
#include "evert/scene/config.hpp"
#include "evert/sim/simulation.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// What a scene costs, and what each feature that it names adds to that, found by leaving it out.
namespace evert {

/// Something that a scene names and need not.
struct Feature {
  std::string name;
  std::vector<std::string> without;  ///< overrides that leave it out
};
/// Those of a scene.
[[nodiscard]] std::vector<Feature> features_of(const SceneConfig& scene);

/// Of a scene on one rank, at its start.
struct StepCost {
  double seconds = 0;      ///< processor time of a step [s]
  double time_step = 0;    ///< [s]
  std::size_t memory = 0;  ///< what building it has added to what is in use [bytes]
};

/// Without a feature.
struct FeatureCost {
  std::string feature;
  std::optional<StepCost> without;  ///< empty: the scene cannot be without it
};

struct SceneCosts {
  StepCost whole;
  std::vector<FeatureCost> features;
};

/// Builds the scene with and without each of its features, all at once, and times their steps in turn, so
/// that what else the machine does falls on all alike; the least of several times counts. Not collective.
/// Leaves out what is refused, or blows up, without a feature; everything, where the scene itself blows up.
[[nodiscard]] SceneCosts scene_costs(const std::string& path, std::span<const std::string> overrides,
                                     std::span<const Feature> features);

}  // namespace evert
