#include "evert/scene/load.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"

#include "events.hpp"
#include "overrides.hpp"
#include "scene_file.hpp"
#include "statics.hpp"
#include "tables.hpp"
#include "yaml.hpp"
#include <algorithm>
#include <filesystem>
#include <fstream>

namespace evert {
namespace {

using schema::Value;

constexpr std::uintmax_t largest_file = 16U
                                        << 20U;  // a scene is written by a person, or by a person's script

std::string read_file(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw UserError(path + ": there is no such file");
  if (std::filesystem::is_directory(status)) throw UserError(path + ": is a directory, not a scene file");
  if (!std::filesystem::is_regular_file(status)) throw UserError(path + ": is not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw UserError(path + ": cannot be opened for reading");
  std::string text;
  std::array<char, 65536> buffer{};
  while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > largest_file) throw UserError(path + ": larger than 16 MiB: not a scene");
  }
  if (file.bad()) throw UserError(path + ": cannot be read");
  return text;
}

/// Rank 0's text on every rank.
void broadcast(MPI_Comm comm, std::string& text) {
  auto length = static_cast<int>(text.size());  // at most largest_file
  MPI_Bcast(&length, 1, MPI_INT, 0, comm);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, 0, comm);
}

/// Files are named relative to the scene, those on the command line relative to the working directory.
void resolve_path(std::string& path, const Value& written, const std::filesystem::path& folder) {
  if (!written.where.starts_with("-set ")) path = (folder / path).lexically_normal().string();
}

/// `map` is where the shape is written.
void resolve_paths(SolidConfig& solid, const Value& map, const std::filesystem::path& folder) {
  std::visit(
      [&]<class Shape>(Shape& shape) {
        if constexpr (std::is_same_v<Shape, MeshShape>)
          resolve_path(shape.surface, *map.find("surface"), folder);
        else if constexpr (requires { shape.of; })
          for (std::size_t i = 0; i < shape.of.size(); ++i)
            resolve_paths(shape.of[i].solid, map.find("of")->items[i], folder);
      },
      solid);
}

void resolve_paths(SceneConfig& scene, const Value& root) {
  const auto folder = std::filesystem::path(scene.file).parent_path();
  for (auto& body : scene.bodies) {
    const auto& written = *root.find("bodies")->find(body.name)->find("mesh");
    if (auto* mesh = std::get_if<FileMesh>(&body.mesh))
      resolve_path(mesh->path, *written.find("file"), folder);
    if (auto* mesh = std::get_if<FilledShape>(&body.mesh)) resolve_paths(mesh->solid, written, folder);
    if (body.plasticity && body.plasticity->goal) {
      const auto& goal = *root.find("bodies")->find(body.name)->find("plasticity")->find("goal");
      if (auto* mesh = std::get_if<MeshGoal>(&body.plasticity->goal->shape))
        resolve_path(mesh->path, *goal.find("file"), folder);
      if (auto* cells = std::get_if<DeformationGoal>(&body.plasticity->goal->shape))
        resolve_path(cells->path, *goal.find("deformations"), folder);
    }
  }
  for (auto& obstacle : scene.obstacles)
    resolve_paths(obstacle.shape.solid, *root.find("obstacles")->find(obstacle.name), folder);
}

/// The same for the files of motions.
void resolve_motion_paths(SceneConfig& scene, const Value& root) {
  const auto folder = std::filesystem::path(scene.file).parent_path();
  for (auto& obstacle : scene.obstacles) {
    if (!obstacle.motion || obstacle.motion->file.empty()) continue;
    auto& file = obstacle.motion->file;
    const auto& written = *root.find("obstacles")->find(obstacle.name)->find("motion")->find("file");
    if (!written.where.starts_with("-set ")) file = (folder / file).lexically_normal().string();
  }
}

void resolve_constraints(SceneConfig& scene, const Value& root) {
  std::vector<std::string> names;
  for (const auto& body : scene.bodies) names.push_back(body.name);
  for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
    auto& constraint = scene.constraints[i];
    const auto found = std::find(names.begin(), names.end(), constraint.body_name);
    if (found == names.end())
      schema::fail(*root.find("constraints")->items[i].find("body"),
                   "constraints[" + std::to_string(i) + "].body",
                   "there is no body " + schema::shown(constraint.body_name) + ": must be " + list_of(names) +
                       did_you_mean(constraint.body_name, names));
    constraint.body = static_cast<std::size_t>(found - names.begin());
  }
}

/// The keys that a checkpoint depends on.
std::string identity_of(const Value& root) {
  Value kept{.kind = Value::Kind::map};
  for (const auto* key : {"name", "gravity", "bodies", "obstacles", "constraints", "events", "filter"})
    if (const auto* value = root.find(key)) kept.set(key, *value);
  return canonical_text(kept);
}

}  // namespace

SceneConfig parse_scene(std::string_view text, const std::string& file,
                        std::span<const std::string> overrides) {
  auto root = parse_yaml(text, file);
  apply_overrides(root, scene_table().info(), overrides);
  auto scene = scene_table().read(root, "");
  scene.file = file;
  resolve_paths(scene, root);
  resolve_motion_paths(scene, root);
  resolve_constraints(scene, root);
  resolve_events(scene, root);
  require_rest(scene, root);
  scene.text = canonical_text(root);
  scene.identity = identity_of(root);
  return scene;
}

std::string read_scene_file(MPI_Comm comm, const std::string& path) {
  std::string text;
  on_root(comm, [&] { text = read_file(path); });
  broadcast(comm, text);
  return text;
}

SceneConfig load_scene(MPI_Comm comm, const std::string& path, std::span<const std::string> overrides) {
  return parse_scene(read_scene_file(comm, path), path, overrides);
}

}  // namespace evert
