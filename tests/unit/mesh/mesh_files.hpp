#pragma once
#include "evert/core/error.hpp"
#include "evert/mesh/mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

/// What the tests of mesh files share.
namespace evert::test {

/// A folder of its own for each test, removed afterwards.
class MeshFileTest : public ::testing::Test {
 protected:
  MeshFileTest() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("evert_mesh_") + info->test_suite_name() +
                                                        "_" + info->name() + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~MeshFileTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::filesystem::path file(const std::string& name, std::string_view content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }

 private:
  std::filesystem::path folder_;
};

inline std::string content_of(const std::filesystem::path& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

/// Expects a UserError of one line whose text holds every fragment.
template <class Work>
void expect_user_error(Work&& work, std::initializer_list<std::string_view> fragments) {
  try {
    work();
    ADD_FAILURE() << "no error, but one that mentions '" << *fragments.begin() << "' is wanted";
  } catch (const UserError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const auto fragment : fragments)
      EXPECT_NE(message.find(fragment), std::string::npos)
          << "'" << message << "' does not mention '" << fragment << "'";
  }
}

/// Bytes of a binary file, in the order of bytes wanted.
class Bytes {
 public:
  explicit Bytes(std::endian order) : swap_(order != std::endian::native) {}

  Bytes& text(std::string_view text) {
    bytes_ += text;
    return *this;
  }
  template <class Number>
  Bytes& put(Number value) {
    std::string raw(sizeof(value), '\0');
    std::memcpy(raw.data(), &value, sizeof(value));
    if (swap_) std::reverse(raw.begin(), raw.end());
    bytes_ += raw;
    return *this;
  }
  template <class Number>
  Bytes& put_all(std::initializer_list<Number> values) {
    for (const auto value : values) put(value);
    return *this;
  }
  [[nodiscard]] const std::string& str() const { return bytes_; }

 private:
  bool swap_;
  std::string bytes_;
};

/// Two tetrahedra, a hexahedron, a wedge and a quadratic tetrahedron in two regions, with two node sets; node
/// 0 is not used. Coordinates need all digits.
inline Mesh mixed_mesh() {
  Mesh mesh;
  mesh.nodes = {
      {1.0 / 3, -1e-17, 1e300 * 1e-290}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.2, -0.7}};
  const auto add = [&](const Vec3d& origin, std::initializer_list<Vec3d> corners) {
    std::vector<GlobalIndex> numbers;
    for (const auto& corner : corners) {
      numbers.push_back(mesh.node_count());
      mesh.nodes.push_back(origin + (1.0 / 3) * corner);
    }
    return numbers;
  };
  const auto hex = add(
      {2, 0, 0}, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
  const auto wedge = add({4, 0, 0}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
  const auto tet10 = add({6, 0, 0}, {{0, 0, 0},
                                     {1, 0, 0},
                                     {0, 1, 0},
                                     {0, 0, 1},
                                     {0.5, 0, 0},
                                     {0.5, 0.5, 0},
                                     {0, 0.5, 0},
                                     {0, 0, 0.5},
                                     {0.5, 0, 0.5},
                                     {0, 0.5, 0.5}});
  mesh.regions = {"hard core", "soft shell"};
  mesh.cells = {{CellType::tet4, {1, 2, 3, 4, 1, 3, 2, 5}, {1, 0}},
                {CellType::hex8, hex, {0}},
                {CellType::wedge6, wedge, {1}},
                {CellType::tet10, tet10, {0}}};
  mesh.node_sets = {{"wall", {1, 3, 4}}, {"a tip", {5}}};
  return mesh;
}

inline void expect_same_cells(const Mesh& a, const Mesh& b) {
  ASSERT_EQ(a.cells.size(), b.cells.size());
  for (std::size_t i = 0; i < a.cells.size(); ++i) {
    EXPECT_EQ(a.cells[i].type, b.cells[i].type);
    EXPECT_EQ(a.cells[i].nodes, b.cells[i].nodes);
  }
}

/// Region names cell by cell: their numbers may differ.
inline std::vector<std::string> regions_of_cells(const Mesh& mesh) {
  std::vector<std::string> names;
  for (const auto& block : mesh.cells)
    for (const auto region : block.region) names.push_back(mesh.regions.at(static_cast<std::size_t>(region)));
  return names;
}

}  // namespace evert::test
