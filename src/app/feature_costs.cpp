#include "feature_costs.hpp"

#include "evert/core/error.hpp"
#include "evert/core/memory_in_use.hpp"
#include "evert/scene/build.hpp"
#include "evert/scene/load.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <memory>

namespace evert {
namespace {

/// A scene in motion.
class Subject {
 public:
  Subject(const std::string& path, const std::vector<std::string>& overrides) {
    const auto scene = load_scene(PETSC_COMM_SELF, path, overrides);
    end_time_ = scene.end_time;
    const std::size_t before = memory_in_use();
    built_ = std::make_unique<BuiltScene>(build_scene(PETSC_COMM_SELF, scene));
    const std::size_t after = memory_in_use();
    cost_.memory = after > before ? after - before : 0;
    cost_.seconds = std::numeric_limits<double>::infinity();
    cost_.time_step = next_step();
    simulation().step(cost_.time_step);  // which also sets the solvers up
  }
  /// Times some steps, as many as a clock can tell.
  void make_steps() {
    constexpr double long_enough = 5e-3;  // [s]
    const auto begin = std::clock();
    double seconds = 0;
    int steps = 0;
    while (seconds < long_enough && steps < 200) {
      simulation().step(next_step());
      ++steps;
      seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    }
    cost_.seconds = std::min(cost_.seconds, seconds / steps);
  }
  [[nodiscard]] const StepCost& cost() const { return cost_; }

 private:
  [[nodiscard]] Simulation& simulation() { return *built_->simulation; }
  [[nodiscard]] double next_step() { return std::min(simulation().suggested_time_step(), end_time_); }

  std::unique_ptr<BuiltScene> built_;
  double end_time_ = 0;  // [s]
  StepCost cost_;
};

/// Null where it cannot be.
std::unique_ptr<Subject> subject(const std::string& path, std::span<const std::string> overrides,
                                 std::span<const std::string> without) {
  std::vector<std::string> all(overrides.begin(), overrides.end());
  all.insert(all.end(), without.begin(), without.end());
  try {
    return std::make_unique<Subject>(path, all);
  } catch (const UserError&) {
    return nullptr;
  } catch (const SimulationError&) {
    return nullptr;
  }
}

void add_features(const BodyConfig& body, bool several, std::vector<Feature>& features) {
  const std::string key = "bodies." + body.name + ".";
  const std::string of_body = several ? " of " + body.name : "";
  const auto add = [&](bool named, const std::string& name, const std::string& without) {
    if (named) features.push_back({name + of_body, {key + without}});
  };
  add(body.damping.has_value(), "damping", "damping=null");
  add(body.plasticity.has_value(), "plasticity", "plasticity=null");
  add(body.mean_dilatation, "mean_dilatation", "mean_dilatation=false");
  add(body.activation.has_value(), "activation", "activation=null");
  add(body.precision == Precision::mixed, "mixed precision", "precision=double");
}

}  // namespace

std::vector<Feature> features_of(const SceneConfig& scene) {
  std::vector<Feature> features;
  for (const auto& body : scene.bodies) add_features(body, scene.bodies.size() > 1, features);
  if (scene.filter) {
    features.push_back({"filter", {"filter=null"}});
    if (scene.integrator.time_step) features.back().without.emplace_back("integrator.time_step=auto");
  }
  if (scene.integrator.mass == MassForm::consistent)
    features.push_back({"consistent masses", {"integrator.mass=lumped"}});
  if (!scene.obstacles.empty()) features.push_back({"obstacles", {"obstacles=null"}});
  if (!scene.constraints.empty()) features.push_back({"constraints", {"constraints=null"}});
  return features;
}

SceneCosts scene_costs(const std::string& path, std::span<const std::string> overrides,
                       std::span<const Feature> features) {
  std::vector<std::unique_ptr<Subject>> subjects;
  subjects.push_back(subject(path, overrides, {}));
  for (const auto& feature : features) subjects.push_back(subject(path, overrides, feature.without));
  constexpr int rounds = 5;
  for (int round = 0; round < rounds; ++round)
    for (auto& of_scene : subjects) {
      if (of_scene == nullptr) continue;
      try {
        of_scene->make_steps();
      } catch (const SimulationError&) {
        of_scene = nullptr;
      }
    }
  SceneCosts costs;
  if (subjects.front() == nullptr) return costs;
  costs.whole = subjects.front()->cost();
  for (std::size_t f = 0; f < features.size(); ++f) {
    const auto& without = subjects[f + 1];
    costs.features.push_back(
        {features[f].name, without == nullptr ? std::nullopt : std::optional<StepCost>(without->cost())});
  }
  return costs;
}

}  // namespace evert
