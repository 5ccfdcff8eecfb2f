#pragma once
#include "evert/app/extreme_case.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

/// What the families of extreme cases are made of.
namespace evert::extremes {

/// A scene of one body, by its parts: YAML in one line each.
struct SceneParts {
  double end_time = 1;  ///< [s]
  std::string mesh = "{generate: ball, radius: 0.5, edge_length: 0.35}";
  std::string material = "{model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.4}";
  double density = 1000;             ///< [kg/m³]
  std::vector<std::string> body{};   ///< more keys of the body
  std::vector<std::string> world{};  ///< more keys of the scene
};
[[nodiscard]] std::string scene_of(const SceneParts& parts);

/// How a body comes to rest from a bad start: it untangles by the recoil, cools, and stops. docs/recovery.md
struct Settling {
  double time = 1;      ///< [s] a length over the speed of sound, over that of a body of 1 m and 10 m/s
  double spin = 0;      ///< [1/s] damping of velocities at the end, times `time`
  double longer = 1;    ///< than 9 of these times
  double contract = 0;  ///< in these times: strong damping first, where nodes are many times the size apart
};
/// The same scene with start, damping, events and steps for that.
[[nodiscard]] SceneParts settling_from(const std::string& start, SceneParts parts,
                                       const Settling& settling = {});

/// A material by name with constants that go together: E = 1e5 Pa, ν = 0.4, and the limit that
/// docs/recovery.md recommends.
struct Model {
  const char* name;
  const char* text;
  const char* body = "";  ///< what the body needs besides: fibres
};
[[nodiscard]] std::span<const Model> all_models();
[[nodiscard]] const Model& model_of(const std::string& name);

/// Elements by name, and a box 1 m long of them.
struct Element {
  const char* name;
  const char* cell;
  int order;
};
inline constexpr std::array<Element, 4> all_elements{
    {{"tet4", "tet6", 1}, {"hex8", "hex8", 1}, {"wedge6", "wedge6", 1}, {"tet10", "tet6", 2}}};
[[nodiscard]] SceneParts box_of(const Element& element, const std::string& cells);

inline constexpr std::array<const char*, 5> start_kinds{"scramble", "flatten_plane", "flatten_line",
                                                        "flatten_point", "inside_out"};
/// With an axis along none of the mesh.
[[nodiscard]] std::string start_of(const std::string& kind, double amplitude = 1);

/// "1e+06" as "1e6".
[[nodiscard]] std::string short_number(double value);

/// A mesh file in the format of Gmsh: `count` tetrahedra in a row, each with a face in common with the next;
/// unit edges.
[[nodiscard]] std::string tetrahedra_in_a_row(int count);
/// Two cubes of one hexahedron, or of six tetrahedra, side by side: the volume groups soft and stiff.
[[nodiscard]] std::string soft_and_stiff(bool tetrahedra);

// The families, one function a file.
void add_starts(std::vector<ExtremeCase>& cases, int ranks);
void add_numbers(std::vector<ExtremeCase>& cases);
void add_steps(std::vector<ExtremeCase>& cases);
void add_products(std::vector<ExtremeCase>& cases);

}  // namespace evert::extremes
