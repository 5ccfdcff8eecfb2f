#include "evert/scene/load.hpp"
#include "evert/scene/reference.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

/// Whatever scene a user can see is valid: the examples and every YAML block of the documentation. A block
/// whose first line is "# fragment" is laid over a scene of the test first; "# fragment of bodies.torus"
/// stands below that key;
/// "# not a scene" is skipped.
namespace evert {
namespace {

namespace fs = std::filesystem;
const fs::path root = EVERT_SOURCE_DIR;

std::string content(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::vector<fs::path> files_below(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> found;
  if (fs::exists(folder))
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().extension() == ending) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

struct Block {
  std::string place;  ///< file:line
  std::string text;
};

std::vector<Block> yaml_blocks(const fs::path& path) {
  std::vector<Block> blocks;
  std::istringstream lines(content(path));
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (!inside && (line == "```yaml" || line == "```yml")) {
      inside = true;
      blocks.push_back({path.string() + ":" + std::to_string(number + 1), ""});
    } else if (inside && line == "```") {
      inside = false;
    } else if (inside) {
      blocks.back().text += line + "\n";
    }
  }
  EXPECT_FALSE(inside) << path << ": a YAML block does not end";
  return blocks;
}

/// What fragments are laid over: has a body of each name that the documentation speaks of.
YAML::Node base_scene() {
  return YAML::Load(R"(
name: base
end_time: 1
bodies:
  torus: &body
    mesh: {generate: ball, radius: 1, edge_length: 0.5}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.3}
    damping: {model: rotated, stiffness_proportional: 0.01}
  ball: *body
  beam: *body
  body: *body
obstacles:
  ground: {shape: half_space}
)");
}

/// Lays `top` over `base`; keys that choose among alternatives replace the whole map.
YAML::Node laid_over(const YAML::Node& base, const YAML::Node& top) {
  if (!base.IsMap() || !top.IsMap() || top["generate"] || top["file"] || top["shape"] || top["alpha"] ||
      top["mu"] || top["mu_10"])
    return YAML::Clone(top);
  auto out = YAML::Clone(base);
  for (const auto& entry : top) {
    const auto key = entry.first.Scalar();
    out[key] = out[key] ? laid_over(out[key], entry.second) : YAML::Clone(entry.second);
  }
  return out;
}

/// {a: {b: node}} for "a.b".
YAML::Node below(const std::string& path, const YAML::Node& node) {
  if (path.empty()) return node;
  const auto dot = std::min(path.find('.'), path.size());
  YAML::Node out;
  out[path.substr(0, dot)] = below(path.substr(std::min(dot + 1, path.size())), node);
  return out;
}

std::string completed(const Block& block) {
  const auto first = block.text.substr(0, block.text.find('\n'));
  constexpr std::string_view mark = "# fragment";
  if (!first.starts_with(mark)) return block.text;
  constexpr std::string_view mark_of = "# fragment of ";
  const auto path = first.starts_with(mark_of) ? first.substr(mark_of.size()) : std::string();
  YAML::Emitter out;
  out << laid_over(base_scene(), below(path, YAML::Load(block.text)));
  return out.c_str();
}

TEST(Documents, examples_are_valid) {
  const auto examples = files_below(root / "examples", ".yaml");
  EXPECT_GE(examples.size(), 3U);
  for (const auto& path : examples)
    EXPECT_NO_THROW(static_cast<void>(parse_scene(content(path), path.string()))) << path;
}

TEST(Documents, examples_say_what_they_show) {
  for (const auto& path : files_below(root / "examples", ".yaml")) {
    const auto text = content(path);
    for (const auto* part : {"# Run:", "# Expected:"})
      EXPECT_NE(text.find(part), std::string::npos) << path << part;
    EXPECT_NE(text.find(fs::relative(path, root).string()), std::string::npos)
        << path << " is not how it is run";
  }
}

TEST(Documents, yaml_blocks_are_valid) {
  auto pages = files_below(root / "docs", ".md");
  pages.push_back(root / "README.md");
  for (const auto& page : pages)
    for (const auto& block : yaml_blocks(page)) {
      if (block.text.starts_with("# not a scene")) continue;
      try {
        static_cast<void>(parse_scene(completed(block), block.place));
      } catch (const std::exception& error) {
        ADD_FAILURE() << block.place << ": " << error.what();
      }
    }
}

TEST(Documents, checker_can_fail) {
  EXPECT_ANY_THROW(static_cast<void>(parse_scene(completed({"", "# fragment\ngravty: [0, 0, 0]\n"}), "")));
  EXPECT_ANY_THROW(
      static_cast<void>(parse_scene(completed({"", "# fragment of bodies.torus\ndensity: 0\n"}), "")));
  EXPECT_ANY_THROW(static_cast<void>(parse_scene(completed({"", "gravity: [0, 0, 0]\n"}), "")));
  EXPECT_NO_THROW(static_cast<void>(parse_scene(completed({"", "# fragment\ngravity: [0, 0, 0]\n"}), "")));
  EXPECT_NO_THROW(static_cast<void>(parse_scene(
      completed({"", "# fragment\nobstacles: {ground: {shape: sphere, center: [0, 0, 0], radius: 1}}\n"}),
      "")));
}

TEST(Documents, scene_reference_is_up_to_date) {
  EXPECT_EQ(content(root / "docs/reference/scene.md"), reference_markdown())
      << "docs/reference/scene.md is stale: run scripts/make-reference";
}

}  // namespace
}  // namespace evert
