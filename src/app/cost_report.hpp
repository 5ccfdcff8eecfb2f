#pragma once
#include "evert/scene/config.hpp"
#include "evert/sim/simulation.hpp"

#include "report.hpp"
#include <span>
#include <string>

namespace evert {

/// Time steps, their number, memory and time by component. Makes some steps.
void report_cost(Report& report, const SceneConfig& scene, Simulation& simulation);

/// What each feature of the scene adds, measured without it. Not collective.
void report_features(Report& report, const SceneConfig& scene, const std::string& path,
                     std::span<const std::string> overrides);

}  // namespace evert
