#pragma once
#include "evert/scene/config.hpp"

#include <mpi.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace evert {

/// A scene file as it is written, of which variants are made: for programs that run one scene many times.
class SceneSource {
 public:
  /// Collective. Reads the file. `overrides` ("path=value") are part of every variant. Throws UserError as
  /// load_scene does.
  SceneSource(MPI_Comm comm, const std::string& path, std::vector<std::string> overrides = {});
  /// Not collective. Of text in memory; `file` names it in messages.
  SceneSource(std::string text, std::string file, std::vector<std::string> overrides = {});

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::vector<std::string>& overrides() const { return overrides_; }

  /// The variant with these overrides on top. Throws UserError as load_scene does.
  [[nodiscard]] SceneConfig variant(std::span<const std::string> overrides = {}) const;
  /// What the scene has at a path like bodies.ball.mesh.edge_length, on one line; empty: it has nothing
  /// there.
  [[nodiscard]] std::optional<std::string> value_at(const std::string& path) const;
  /// The names in the map at a path; none: there is no map.
  [[nodiscard]] std::vector<std::string> names_at(const std::string& path) const;
  /// The variant as YAML for a file in `folder`: files that it names are found from there.
  [[nodiscard]] std::string yaml(std::span<const std::string> overrides, const std::string& folder) const;

 private:
  std::string text_, file_;
  std::vector<std::string> overrides_;
};

}  // namespace evert
