#include "evert/mesh/surface_reader.hpp"
#include "evert/shapes/triangle_solid.hpp"

#include "mesh_files.hpp"
#include <bit>
#include <cstring>

namespace evert::test {
namespace {

/// A tetrahedron with corners at the origin and on the axes.
const std::vector<Vec3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<Triangle> faces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

template <class T>
std::string bytes_of(T value, bool big_endian) {
  std::string raw(sizeof(T), '\0');
  std::memcpy(raw.data(), &value, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) std::ranges::reverse(raw);
  return raw;
}

std::string ascii_stl() {
  std::string text = "solid part\n";
  for (const auto& face : faces) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const auto corner : face) {
      const auto& p = corners[static_cast<std::size_t>(corner)];
      text += "   vertex " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) +
              "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid part\n";
}

std::string binary_stl(const std::string& header = "made by a test") {
  std::string text = header + std::string(80 - header.size(), ' ') + bytes_of(std::uint32_t{4}, false);
  for (const auto& face : faces) {
    text += std::string(12, '\0');
    for (const auto corner : face)
      for (const double c : corners[static_cast<std::size_t>(corner)].components)
        text += bytes_of(static_cast<float>(c), false);
    text += std::string(2, '\0');
  }
  return text;
}

std::string ply(const std::string& format) {
  std::string text =
      "ply\nformat " + format +
      " 1.0\ncomment test\nelement vertex 4\nproperty float x\nproperty double y\n"
      "property float z\nproperty uchar red\nelement face 4\n"
      "property list uchar int vertex_indices\nelement edge 1\nproperty int vertex1\nend_header\n";
  const bool big = format == "binary_big_endian";
  for (const auto& p : corners)
    text += format == "ascii"
                ? std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + " 255\n"
                : bytes_of(static_cast<float>(p[0]), big) + bytes_of(p[1], big) +
                      bytes_of(static_cast<float>(p[2]), big) + "r";
  for (const auto& face : faces) {
    text += format == "ascii" ? "3" : std::string(1, '\3');
    for (const auto corner : face)
      text += format == "ascii" ? " " + std::to_string(corner) : bytes_of(corner, big);
    if (format == "ascii") text += "\n";
  }
  return text + (format == "ascii" ? "7\n" : bytes_of(std::int32_t{7}, big));
}

const std::string obj =
    "# a test\nmtllib x.mtl\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nv 0 0 1\nvn 0 0 1\n"
    "f 1/1/1 3//1 2\nf -4 2 -1\nf 1 4 3 # with a comment\nf 2 3 4\n";
const std::string off =
    "OFF\n# a test\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1 255 0 0\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

class SurfaceReader : public MeshFileTest {
 protected:
  TriangleSurface read(const std::string& name, const std::string& content) {
    (void)file(name, content);
    return read_closed_surface(path(name));
  }
  void expect_refused(const std::string& name, const std::string& content, std::string_view fault) {
    (void)file(name, content);
    expect_user_error([&] { (void)read_closed_surface(path(name)); }, {fault, name});
  }
};

TEST_F(SurfaceReader, reads_every_format) {
  const std::vector<std::pair<std::string, std::string>> files{{"a.stl", ascii_stl()},
                                                               {"b.STL", binary_stl()},
                                                               {"solid.stl", binary_stl("solid but binary")},
                                                               {"a.ply", ply("ascii")},
                                                               {"little.ply", ply("binary_little_endian")},
                                                               {"big.ply", ply("binary_big_endian")},
                                                               {"a.obj", obj},
                                                               {"a.off", off}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const TriangleSolid solid(read(name, content));
    EXPECT_NEAR(solid.signed_distance({0.1, 0.2, 0.3}), -0.1, 1e-15);
    EXPECT_EQ(solid.bounds().upper, (Vec3d{1, 1, 1}));
  }
}

TEST_F(SurfaceReader, makes_fans_of_polygons) {
  const auto surface = read("pyramid.off",
                            "OFF 5 5 8\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n"
                            "4 0 3 2 1\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n");
  EXPECT_EQ(surface.triangles.size(), 6U);
}

TEST_F(SurfaceReader, refuses_what_is_wrong_with_its_place) {
  expect_refused("x.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n", ":3: a face names a point that is not there");
  expect_refused("x.obj", "v 0 0 0\nf 1 1\n", ":2: a face has 2 corners, but must have at least 3");
  expect_refused("x.obj", "v 0 0 0\nf 1 x 1\n", "'x' is no corner of a face");
  expect_refused("x.obj", "v 0 0\n", "x.obj");
  expect_refused("x.obj", "v 0 0 nan\n", "x.obj:1");
  expect_refused("x.obj", "# nothing\n", "has no triangle");
  expect_refused("x.off", "OFF\n1000000000000 1 0\n0 0 0\n", "x.off:2");
  expect_refused("x.off", "PLY\n", "must begin with OFF");
  expect_refused("x.stl", "solid a\n facet normal 0 0 0\n outer loop\n vertex 0 0 0\n endloop\n", "x.stl:5");
  expect_refused("x.stl", ascii_stl().substr(0, 300), "x.stl");
  expect_refused("x.stl", binary_stl().substr(0, 200), "x.stl");
  expect_refused("x.stl", "not a solid at all", "must begin with 'solid', or be binary");
  expect_refused("x.ply", ply("binary_little_endian").substr(0, 330), "x.ply");
  expect_refused("x.ply", ply("binary_middle_endian"), "is no format");
  expect_refused("x.ply", "ply\nelement vertex 4\nproperty float x\nend_header\n",
                 "the header has no format");
  expect_refused("x.txt", "solid", "must be .obj, .stl, .ply or .off");
  expect_user_error([&] { (void)read_surface(path("missing.stl")); }, {"missing.stl", "no such file"});
}

/// Files that lose any part of their end, or any byte of which changes, are read or refused, and nothing
/// else.
TEST_F(SurfaceReader, survives_damage) {
  for (const auto& [name, content] : {std::pair<std::string, std::string>{"d.stl", binary_stl()},
                                      {"d.ply", ply("binary_big_endian")},
                                      {"e.ply", ply("ascii")},
                                      {"d.obj", obj},
                                      {"d.off", off}}) {
    for (std::size_t cut = 0; cut < content.size(); cut += 7) {
      auto damaged = content;
      damaged[cut] = static_cast<char>(damaged[cut] ^ 0x55);
      for (const auto& text : {content.substr(0, cut), damaged}) {
        (void)file(name, text);
        try {
          (void)read_closed_surface(path(name));
        } catch (const UserError& error) {
          EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
        }
      }
    }
  }
}

}  // namespace
}  // namespace evert::test
