#include "events.hpp"

#include "evert/core/error.hpp"
#include "evert/scene/load.hpp"

#include "tables.hpp"
#include <algorithm>
#include <array>
#include <string_view>

namespace evert {
namespace {

using schema::join;
using schema::Value;

/// A key that an event may set in this scene.
struct Settable {
  std::string path;
  EventTarget target;
  std::size_t owner = 0;
  std::optional<std::size_t> group{};
};

void add_material(std::vector<Settable>& out, const Settable& place,
                  const std::optional<DampingConfig>& damping, const MaterialConfig* material) {
  const auto add = [&](const char* key, EventTarget target) {
    out.push_back({join(place.path, key), target, place.owner, place.group});
  };
  if (material != nullptr && material->youngs_modulus) {
    add("material.youngs_modulus", EventTarget::youngs_modulus);
    add("material.poissons_ratio", EventTarget::poissons_ratio);
  }
  if (material != nullptr && material->mu) {
    add("material.lambda", EventTarget::lambda);
    add("material.mu", EventTarget::mu);
  }
  if (!damping) return;
  if (damping->mass_proportional) add("damping.mass_proportional", EventTarget::mass_proportional);
  if (damping->mass_ratio) add("damping.mass_ratio", EventTarget::mass_ratio);
  if (damping->frequency > 0) add("damping.frequency", EventTarget::frequency);
  if (damping->model == DampingModel::none) return;
  if (damping->stiffness_proportional) {
    add("damping.stiffness_proportional", EventTarget::stiffness_proportional);
  } else if (damping->stiffness_ratio) {
    add("damping.stiffness_ratio", EventTarget::stiffness_ratio);
  } else {
    add("damping.alpha", EventTarget::alpha);
    add("damping.beta", EventTarget::beta);
  }
}

std::vector<Settable> settable_keys(const SceneConfig& scene) {
  std::vector<Settable> out{{"gravity", EventTarget::gravity}};
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    const auto path = "bodies." + body.name;
    add_material(out, {path, {}, b}, body.damping, &body.material);
    for (std::size_t g = 0; g < body.groups.size(); ++g) {
      const auto& group = body.groups[g];
      add_material(out, {path + ".groups." + group.name, {}, b, g}, group.damping,
                   group.material ? &*group.material : nullptr);
    }
  }
  for (std::size_t o = 0; o < scene.obstacles.size(); ++o)
    out.push_back({"obstacles." + scene.obstacles[o].name + ".friction", EventTarget::friction, o});
  return out;
}

/// The map that holds the last key of `path`.
const Value& holder(const Value& root, std::string_view path) {
  const auto dot = path.find('.');
  if (dot == std::string_view::npos) return root;
  return holder(*root.find(path.substr(0, dot)), path.substr(dot + 1));
}

/// The value of `event`, read as `path` of the scene with `to` in the place of what stands there: all checks
/// of the table apply.
void read_value(EventConfig& event, const Value& root, const Value& to) {
  const auto dot = event.set.rfind('.');
  const auto parent = event.set.substr(0, dot == std::string::npos ? 0 : dot);
  Value map = holder(root, event.set);
  map.set(event.set.substr(dot == std::string::npos ? 0 : dot + 1), to);
  switch (event.target) {
    case EventTarget::gravity:
      event.vector = gravity_type().read(to, event.set);
      break;
    case EventTarget::friction:
      event.value = friction_type().read(to, event.set);
      break;
    case EventTarget::youngs_modulus:
      event.value = *material_table().read(map, parent).youngs_modulus;
      break;
    case EventTarget::poissons_ratio:
      event.value = *material_table().read(map, parent).poissons_ratio;
      break;
    case EventTarget::lambda:
      event.value = *material_table().read(map, parent).lambda;
      break;
    case EventTarget::mu:
      event.value = *material_table().read(map, parent).mu;
      break;
    case EventTarget::stiffness_proportional:
      event.value = *damping_table().read(map, parent).stiffness_proportional;
      break;
    case EventTarget::stiffness_ratio:
      event.value = *damping_table().read(map, parent).stiffness_ratio;
      break;
    case EventTarget::alpha:
      event.value = damping_table().read(map, parent).alpha;
      break;
    case EventTarget::beta:
      event.value = damping_table().read(map, parent).beta;
      break;
    case EventTarget::mass_proportional:
      event.value = *damping_table().read(map, parent).mass_proportional;
      break;
    case EventTarget::mass_ratio:
      event.value = *damping_table().read(map, parent).mass_ratio;
      break;
    case EventTarget::frequency:
      event.value = damping_table().read(map, parent).frequency;
      break;
  }
}

}  // namespace

void resolve_events(SceneConfig& scene, const Value& root) {
  if (scene.events.empty()) return;
  const auto settable = settable_keys(scene);
  std::vector<std::string> paths;
  for (const auto& key : settable) paths.push_back(key.path);
  const auto& list = *root.find("events");
  for (std::size_t i = 0; i < scene.events.size(); ++i) {
    auto& event = scene.events[i];
    const auto path = "events[" + std::to_string(i) + "]";
    const auto found = std::find(paths.begin(), paths.end(), event.set);
    if (found == paths.end())
      schema::fail(*list.items[i].find("set"), join(path, "set"),
                   schema::shown(event.set) + " is nothing that an event can set in this scene" +
                       did_you_mean(event.set, paths) + "; 'evert explain events.set' says what can be");
    const auto& key = settable[static_cast<std::size_t>(found - paths.begin())];
    event.target = key.target;
    event.owner = key.owner;
    event.group = key.group;
    read_value(event, root, *list.items[i].find("to"));
  }
  std::stable_sort(scene.events.begin(), scene.events.end(),
                   [](const EventConfig& a, const EventConfig& b) { return a.at < b.at; });
}

void apply_event(SceneConfig& scene, const EventConfig& event) {
  if (event.target == EventTarget::gravity) {
    scene.gravity = event.vector;
    return;
  }
  if (event.target == EventTarget::friction) {
    scene.obstacles[event.owner].friction = event.value;
    return;
  }
  auto& body = scene.bodies[event.owner];
  auto& material = event.group ? *body.groups[*event.group].material : body.material;
  auto& damping = event.group ? body.groups[*event.group].damping : body.damping;
  switch (event.target) {
    case EventTarget::youngs_modulus:
      material.youngs_modulus = event.value;
      break;
    case EventTarget::poissons_ratio:
      material.poissons_ratio = event.value;
      break;
    case EventTarget::lambda:
      material.lambda = event.value;
      break;
    case EventTarget::mu:
      material.mu = event.value;
      break;
    case EventTarget::stiffness_proportional:
      damping->stiffness_proportional = event.value;
      break;
    case EventTarget::stiffness_ratio:
      damping->stiffness_ratio = event.value;
      break;
    case EventTarget::alpha:
      damping->alpha = event.value;
      break;
    case EventTarget::beta:
      damping->beta = event.value;
      break;
    case EventTarget::mass_proportional:
      damping->mass_proportional = event.value;
      break;
    case EventTarget::mass_ratio:
      damping->mass_ratio = event.value;
      break;
    case EventTarget::frequency:
      damping->frequency = event.value;
      break;
    case EventTarget::gravity:
    case EventTarget::friction:
      break;
  }
}

}  // namespace evert
