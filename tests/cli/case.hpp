#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What a case of the table in cases.cpp is made of.
namespace evert::cli {

/// A file in the directory of the case; a directory when the path ends in '/'.
struct File {
  std::string path;
  std::string content{};
};

/// Replaces the only occurrence of the first string by the second.
using Edit = std::pair<std::string, std::string>;

struct Case {
  std::string name;      ///< letters, digits and _
  std::string before{};  ///< arguments of a run that must succeed first
  std::function<void(const std::filesystem::path& place)> spoil{};  ///< what happens to the files after that
  std::string command = "run scene.yaml";  ///< arguments of the program; quotes as in split()
  std::vector<File> files{};               ///< what its directory holds
  std::optional<int> disk_kib{};           ///< size of a file system of its own at disk/
  int exit_code = 2;
  std::vector<std::string> says{};  ///< all in the one line on standard error; with exit code 0 in the output
  std::vector<int> ranks{1, 3};
  std::function<void(const std::filesystem::path& place)> inspect{};  ///< what it must have left behind
};

/// Every case there is.
[[nodiscard]] const std::vector<Case>& all_cases();

/// Those of muscle and tendon.
[[nodiscard]] std::vector<Case> fibre_cases();
[[nodiscard]] std::vector<Case> extremes_cases();
[[nodiscard]] std::vector<Case> filter_cases();
[[nodiscard]] std::vector<Case> material_cases();
[[nodiscard]] std::vector<Case> quasistatic_cases();
[[nodiscard]] std::vector<Case> mass_cases();
[[nodiscard]] std::vector<Case> shape_cases();
/// Those of generated meshes with bad elements.
[[nodiscard]] std::vector<Case> bad_mesh_cases();
[[nodiscard]] std::vector<Case> motion_cases();
[[nodiscard]] std::vector<Case> rigid_cases();
[[nodiscard]] std::vector<Case> explicit_cases();
[[nodiscard]] std::vector<Case> stability_cases();
[[nodiscard]] std::vector<Case> plasticity_cases();
[[nodiscard]] std::vector<Case> trade_cases();

// --- good input to spoil

/// scene.yaml: a cube of 48 tetrahedra on its way to the ground for a few steps; it runs as it stands.
[[nodiscard]] File scene(const std::vector<Edit>& edits = {});
/// The same with its mesh from a file.
[[nodiscard]] File scene_with_mesh(const std::string& mesh_file);
/// A cube of 6 tetrahedra, as Gmsh 2.2 and 4.1 ASCII, Medit, legacy VTK.
[[nodiscard]] File gmsh2(const std::vector<Edit>& edits = {});
[[nodiscard]] File gmsh4(const std::vector<Edit>& edits = {});
[[nodiscard]] File medit(const std::vector<Edit>& edits = {});

/// The file cut after `tenths` tenths of its bytes.
[[nodiscard]] File cut(File file, int tenths);

}  // namespace evert::cli
