#include "events.hpp"

#include "evert/core/error.hpp"
#include "evert/scene/load.hpp"

#include "tables.hpp"
#include <algorithm>
#include <array>
#include <numeric>
#include <string_view>
#include <type_traits>
#include <utility>

namespace evert {
namespace {

using schema::join;
using schema::Value;

template <class Config>
using Number = std::pair<std::string_view, std::optional<double> Config::*>;

constexpr std::array<Number<MaterialConfig>, 4> material_numbers{
    {{"youngs_modulus", &MaterialConfig::youngs_modulus},
     {"poissons_ratio", &MaterialConfig::poissons_ratio},
     {"lambda", &MaterialConfig::lambda},
     {"mu", &MaterialConfig::mu}}};
constexpr std::array<Number<DampingConfig>, 4> damping_numbers{
    {{"stiffness_proportional", &DampingConfig::stiffness_proportional},
     {"stiffness_ratio", &DampingConfig::stiffness_ratio},
     {"mass_proportional", &DampingConfig::mass_proportional},
     {"mass_ratio", &DampingConfig::mass_ratio}}};
constexpr std::array<std::pair<std::string_view, double DampingConfig::*>, 3> plain_damping_numbers{
    {{"alpha", &DampingConfig::alpha},
     {"beta", &DampingConfig::beta},
     {"frequency", &DampingConfig::frequency}}};

/// The number `key`, or null where it is not given.
double* number_of(MaterialConfig& material, std::string_view key) {
  for (const auto& [name, member] : material_numbers)
    if (name == key && material.*member) return &*(material.*member);
  return nullptr;
}

double* number_of(DampingConfig& damping, std::string_view key) {
  for (const auto& [name, member] : damping_numbers)
    if (name == key && damping.*member) return &*(damping.*member);
  const bool by_coefficients =
      damping.model != DampingModel::none && !damping.stiffness_proportional && !damping.stiffness_ratio;
  for (const auto& [name, member] : plain_damping_numbers)
    if (name == key && (key == "frequency" ? damping.frequency > 0 : by_coefficients))
      return &(damping.*member);
  return nullptr;
}

/// A key that an event may set in this scene.
struct Settable {
  std::string path;
  EventTarget target;
  std::size_t owner = 0;
  std::optional<std::size_t> group{};
};

/// Adds what is given of a material or damping that stands at `place`.
template <class Config>
void add_numbers(std::vector<Settable>& out, const Settable& place, Config& config) {
  const auto add = [&](std::string_view key) {
    if (number_of(config, key) != nullptr)
      out.push_back({join(place.path, key), place.target, place.owner, place.group});
  };
  if constexpr (std::is_same_v<Config, MaterialConfig>) {
    for (const auto& [key, member] : material_numbers) add(key);
  } else {
    for (const auto& [key, member] : damping_numbers) add(key);
    for (const auto& [key, member] : plain_damping_numbers) add(key);
  }
}

std::vector<Settable> settable_keys(SceneConfig& scene) {
  std::vector<Settable> out{{"gravity", EventTarget::gravity}};
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    auto& body = scene.bodies[b];
    const auto path = "bodies." + body.name;
    add_numbers(out, {path + ".material", EventTarget::material, b}, body.material);
    if (body.damping) add_numbers(out, {path + ".damping", EventTarget::damping, b}, *body.damping);
    for (std::size_t g = 0; g < body.groups.size(); ++g) {
      auto& group = body.groups[g];
      const auto of_group = path + ".groups." + group.name;
      if (group.material)
        add_numbers(out, {of_group + ".material", EventTarget::material, b, g}, *group.material);
      if (group.damping)
        add_numbers(out, {of_group + ".damping", EventTarget::damping, b, g}, *group.damping);
    }
  }
  for (std::size_t o = 0; o < scene.obstacles.size(); ++o)
    out.push_back({"obstacles." + scene.obstacles[o].name + ".friction", EventTarget::friction, o});
  return out;
}

std::string_view last_key(std::string_view path) {
  const auto dot = path.rfind('.');
  return path.substr(dot == std::string_view::npos ? 0 : dot + 1);
}

/// The map that holds the last key of `path`.
Value& holder(Value& root, std::string_view path) {
  const auto dot = path.find('.');
  if (dot == std::string_view::npos) return root;
  return holder(*root.find(path.substr(0, dot)), path.substr(dot + 1));
}

/// The value of `event`, read as `path` of the scene with `to` in the place of what stands there: all checks
/// of the table apply. `root` is the scene as the events before have left it.
void read_value(EventConfig& event, Value& root, const Value& to) {
  const auto key = last_key(event.set);
  const auto parent = event.set.substr(0, event.set.size() - std::min(event.set.size(), key.size() + 1));
  Value& map = holder(root, event.set);
  map.set(std::string(key), to);
  const auto number_in = [&](auto config) { return *number_of(config, key); };
  switch (event.target) {
    case EventTarget::gravity:
      event.vector = gravity_type().read(to, event.set);
      break;
    case EventTarget::friction:
      event.value = friction_type().read(to, event.set);
      break;
    case EventTarget::material:
      event.value = number_in(material_table().read(map, parent));
      break;
    case EventTarget::damping:
      event.value = number_in(damping_table().read(map, parent));
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
  std::vector<std::size_t> in_time(scene.events.size());
  std::iota(in_time.begin(), in_time.end(), 0);
  std::ranges::stable_sort(in_time, {}, [&](std::size_t i) { return scene.events[i].at; });
  Value changed = root;
  std::vector<EventConfig> sorted;
  for (const std::size_t i : in_time) {
    auto& event = sorted.emplace_back(scene.events[i]);
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
    read_value(event, changed, *list.items[i].find("to"));
  }
  scene.events = std::move(sorted);
}

void apply_event(SceneConfig& scene, const EventConfig& event) {
  const auto set = [&](auto& config) { *number_of(config, last_key(event.set)) = event.value; };
  switch (event.target) {
    case EventTarget::gravity:
      scene.gravity = event.vector;
      break;
    case EventTarget::friction:
      scene.obstacles[event.owner].friction = event.value;
      break;
    case EventTarget::material: {
      auto& body = scene.bodies[event.owner];
      set(event.group ? *body.groups[*event.group].material : body.material);
      break;
    }
    case EventTarget::damping: {
      auto& body = scene.bodies[event.owner];
      set(*(event.group ? body.groups[*event.group].damping : body.damping));
      break;
    }
  }
}

}  // namespace evert
