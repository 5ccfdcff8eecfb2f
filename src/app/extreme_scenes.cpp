#include "extreme_scenes.hpp"

#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"

#include <algorithm>
#include <cmath>

namespace evert::extremes {
namespace {

constexpr std::array<Model, 8> models{{
    {"neo_hookean",
     "{model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.4, compression_limit: 0.99}"},
    {"st_venant_kirchhoff",
     "{model: st_venant_kirchhoff, youngs_modulus: 1e5, poissons_ratio: 0.4, compression_limit: 0.9}"},
    {"rotated_linear", "{model: rotated_linear, youngs_modulus: 1e5, poissons_ratio: 0.4}"},
    {"mooney_rivlin",
     "{model: mooney_rivlin, youngs_modulus: 1e5, poissons_ratio: 0.4, compression_limit: 0.9}"},
    {"spline", "{model: spline, youngs_modulus: 1e5, poissons_ratio: 0.4}"},
    {"stable_neo_hookean", "{model: stable_neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.4}"},
    {"muscle", "{model: muscle, youngs_modulus: 1e5, poissons_ratio: 0.4, peak_stress: 1e4}",
     "fibres: {direction: [1, 0, 0]}"},
    {"tendon", "{model: tendon, youngs_modulus: 1e5, poissons_ratio: 0.4, peak_stress: 1e4}",
     "fibres: {direction: [1, 0, 0]}"},
}};

/// A mesh file by its nodes and by its cells as lines of Gmsh's type, group and node numbers from 1.
std::string gmsh_text(const std::vector<std::array<double, 3>>& nodes, const std::vector<std::string>& cells,
                      const std::string& groups = "") {
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + groups + "$Nodes\n" + std::to_string(nodes.size()) + "\n";
  for (std::size_t i = 0; i < nodes.size(); ++i)
    text += formatted("%zu %.17g %.17g %.17g\n", i + 1, nodes[i][0], nodes[i][1], nodes[i][2]);
  text += "$EndNodes\n$Elements\n" + std::to_string(cells.size()) + "\n";
  for (std::size_t c = 0; c < cells.size(); ++c) text += std::to_string(c + 1) + " " + cells[c] + "\n";
  return text + "$EndElements\n";
}

}  // namespace

std::string scene_of(const SceneParts& parts) {
  std::string text =
      "name: extreme\n" + formatted("end_time: %.17g\n", parts.end_time) + "bodies:\n  body:\n";
  text += "    mesh: " + parts.mesh + "\n";
  text += formatted("    density: %.17g\n", parts.density);
  text += "    material: " + parts.material + "\n";
  for (const auto& line : parts.body)
    if (!line.empty()) text += "    " + line + "\n";
  for (const auto& line : parts.world) text += line + "\n";
  return text;
}

SceneParts settling_from(const std::string& start, SceneParts parts, const Settling& settling) {
  constexpr double recoil = 1e-5, cooling = 1e-4,
                   resting = 0.02;  // [s] stiffness-proportional, of a time of 1
  const double unit = settling.time, begin = settling.contract;
  parts.end_time = (begin + 9 * settling.longer) * unit;
  parts.body.push_back("start: " + start);
  parts.body.push_back(formatted("damping: {model: %s, stiffness_proportional: %.17g, mass_proportional: 0}",
                                 begin > 0 ? "rotated" : "objective", (begin > 0 ? resting : recoil) * unit));
  parts.world.emplace_back("integrator: {max_strain_increment: 0.05}");
  parts.world.emplace_back("events:");
  const auto event = [&](double at, const char* what, double to) {
    parts.world.push_back(
        formatted("  - {at: %.17g, set: bodies.body.damping.%s, to: %.17g}", at * unit, what, to));
  };
  if (begin > 0) event(begin, "stiffness_proportional", recoil * unit);
  event(begin + 2, "stiffness_proportional", cooling * unit);
  event(begin + 4, "stiffness_proportional", resting * unit);
  if (settling.spin > 0) event(begin + 4, "mass_proportional", settling.spin / unit);
  return parts;
}

std::span<const Model> all_models() { return models; }

const Model& model_of(const std::string& name) {
  const auto found = std::ranges::find_if(models, [&](const Model& model) { return name == model.name; });
  EVERT_ASSERT(found != models.end(), name);
  return *found;
}

SceneParts box_of(const Element& element, const std::string& cells) {
  SceneParts parts;
  parts.mesh = "{generate: box, size: [1, 0.5, 0.5], cells: " + cells + ", cell: " + element.cell + "}";
  if (element.order > 1) parts.body.push_back("order: " + std::to_string(element.order));
  return parts;
}

std::string start_of(const std::string& kind, double amplitude) {
  std::string text = "{kind: " + kind + formatted(", amplitude: %.17g", amplitude);
  if (kind != "scramble" && kind != "flatten_point") text += ", axis: [1, 2, 3]";
  return text + "}";
}

std::string short_number(double value) {
  auto text = formatted("%g", value);
  for (const char* padded : {"e+0", "e+"})
    if (const auto at = text.find(padded); at != std::string::npos)
      text.replace(at, std::string(padded).size(), "e");
  if (const auto at = text.find("e-0"); at != std::string::npos) text.erase(at + 2, 1);
  return text;
}

std::string tetrahedra_in_a_row(int count) {
  // Boerdijk and Coxeter's helix: any four nodes in a row are the corners of a regular tetrahedron.
  const double radius = 3 * std::sqrt(3.0) / 10, rise = 1 / std::sqrt(10.0), turn = std::acos(-2.0 / 3);
  std::vector<std::array<double, 3>> nodes;
  for (int n = 0; n < count + 3; ++n)
    nodes.push_back({radius * std::cos(n * turn), radius * std::sin(n * turn), n * rise});
  std::vector<std::string> cells;
  for (int n = 1; n <= count; ++n) cells.push_back(formatted("4 2 1 1 %d %d %d %d", n, n + 1, n + 2, n + 3));
  return gmsh_text(nodes, cells);
}

std::string soft_and_stiff(bool tetrahedra) {
  std::vector<std::array<double, 3>> nodes;
  for (int i = 0; i < 3; ++i)
    for (const double z : {0.0, 0.5})
      for (const double y : {0.0, 0.5}) nodes.push_back({0.5 * i, y, z});  // 1 + 4 i + 2 (z > 0) + (y > 0)
  std::vector<std::string> cells;
  for (int cube = 0; cube < 2; ++cube) {
    const int group = cube + 1;
    const int first = 1 + 4 * cube;
    // The corners of a hexahedron: the lower face around, then the upper one.
    const std::array<int, 8> at{first,     first + 4, first + 5, first + 1,
                                first + 2, first + 6, first + 7, first + 3};
    if (!tetrahedra) {
      cells.push_back(formatted("5 2 %d %d %d %d %d %d %d %d %d %d", group, group, at[0], at[1], at[2], at[3],
                                at[4], at[5], at[6], at[7]));
      continue;
    }
    // Six around the diagonal from 0 to 6.
    constexpr std::array<std::array<std::size_t, 2>, 6> around{
        {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}};
    for (const auto& [a, b] : around)
      cells.push_back(formatted("4 2 %d %d %d %d %d %d", group, group, at[0], at[a], at[b], at[6]));
  }
  return gmsh_text(nodes, cells, "$PhysicalNames\n2\n3 1 \"soft\"\n3 2 \"stiff\"\n$EndPhysicalNames\n");
}

}  // namespace evert::extremes
