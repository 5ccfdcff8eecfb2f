#include "evert/io/frame_writer.hpp"
#include "evert/io/html_view.hpp"
#include "evert/io/surface.hpp"

#include <gtest/gtest.h>

#include "../../mpi/io/scratch.hpp"
#include "../../mpi/mesh/test_meshes.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace evert {
namespace {

namespace fs = std::filesystem;

// --- a run whose frames are known functions of position and time

Vec3d moved(const Vec3d& rest, double time) {
  return {{rest[0] + 0.1 * time, rest[1] * (1 - 1.5 * time), rest[2] * (1 + time)}};
}
double stretch_of(std::size_t cell, double time) {
  return 1 - time * (1 + 0.1 * static_cast<double>(cell % 7));
}

constexpr double interval = 0.125;  // [s]

void write_run(const Mesh& mesh, const std::string& path, int frames, const FrameFields& fields = {},
               FrameWriter::Obstacles obstacles = {}) {
  const auto distributed = distribute(MPI_COMM_SELF, mesh);
  NodeField positions(distributed);
  const NodeField velocities(distributed);
  FrameWriter writer(distributed, path, fields, obstacles);
  for (int frame = 0; frame < frames; ++frame) {
    const double time = interval * frame;
    for (std::size_t node = 0; node < distributed.rest_positions.size(); ++node) {
      const auto position = moved(distributed.rest_positions[node], time);
      std::ranges::copy(position.components,
                        positions.owned().begin() + static_cast<std::ptrdiff_t>(3 * node));
    }
    for (const auto& obstacle : obstacles) obstacle->move_to({.end = time, .dt = interval});
    writer.write({time, frame, positions, velocities, [&](std::size_t block, std::span<double> per_cell) {
                    for (std::size_t i = 0; i < per_cell.size(); ++i)
                      per_cell[i] =
                          stretch_of(static_cast<std::size_t>(distributed.cells[block].global_ids[i]), time);
                  }});
  }
}

// --- reading the page back, as the browser does

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const auto first = text.find(begin);
  if (first == std::string::npos) return "";
  const auto start = first + begin.size();
  return text.substr(start, text.find(end, start) - start);
}

std::string script_of(const std::string& page, const std::string& id) {
  return between(page, "id=\"" + id + "\">", "</script>");
}

/// The number after a key of the page's facts.
double fact(const std::string& page, const std::string& key) {
  return std::stod(between(script_of(page, "facts"), "\"" + key + "\": ", ","));
}

std::vector<double> numbers_in(std::string text) {
  for (char& c : text)
    if (c == '[' || c == ']' || c == ',') c = ' ';
  std::istringstream in(text);
  return {std::istream_iterator<double>(in), {}};
}

std::vector<std::uint8_t> from_base64(const std::string& text) {
  static const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=' || c == '\n') continue;
    EXPECT_NE(alphabet.find(c), std::string::npos) << c;
    bits = bits << 6 | static_cast<std::uint32_t>(alphabet.find(c));
    count += 6;
    if (count >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (count -= 8) & 0xff));
  }
  return bytes;
}

std::uint32_t little_endian(const std::vector<std::uint8_t>& bytes, std::size_t place, std::size_t size) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < size; ++i) number |= std::uint32_t{bytes.at(place * size + i)} << (8 * i);
  return number;
}

/// The frames of a page, decoded.
struct Decoded {
  explicit Decoded(const std::string& page)
      : lower(numbers_in(between(script_of(page, "facts"), "\"lower\": ", "]"))),
        upper(numbers_in(between(script_of(page, "facts"), "\"upper\": ", "]"))),
        rows(numbers_in(between(script_of(page, "facts"), "\"frames\": ", "]]"))),
        triangles(from_base64(script_of(page, "triangles"))) {
    std::istringstream lines(script_of(page, "frames"));
    for (std::string line; std::getline(lines, line);) {
      const auto blank = line.find(' ');
      frames.push_back(from_base64(line.substr(0, blank)));
      const auto second = line.find(' ', blank + 1);
      dots.push_back(from_base64(line.substr(blank + 1, second - blank - 1)));
      obstacle_points.push_back(from_base64(line.substr(second + 1)));
    }
  }

  [[nodiscard]] double number(std::size_t frame) const { return rows.at(3 * frame); }
  [[nodiscard]] double time(std::size_t frame) const { return rows.at(3 * frame + 1); }
  [[nodiscard]] double inverted(std::size_t frame) const { return rows.at(3 * frame + 2); }
  [[nodiscard]] double position(std::size_t frame, std::size_t vertex, std::size_t c) const {
    return coordinate(frames[frame], 4 * vertex, c);
  }
  /// Coordinate c of the centre of an inverted cell.
  [[nodiscard]] double dot(std::size_t frame, std::size_t number, std::size_t c) const {
    return coordinate(dots[frame], 3 * number, c);
  }
  [[nodiscard]] std::size_t dot_count(std::size_t frame) const { return dots[frame].size() / 6; }
  [[nodiscard]] double stretch(std::size_t frame, std::size_t vertex) const {
    return (static_cast<double>(little_endian(frames[frame], 4 * vertex + 3, 2)) - 32768) / 32767;
  }

  std::vector<double> lower, upper, rows;
  std::vector<std::uint8_t> triangles;
  std::vector<std::vector<std::uint8_t>> frames, dots, obstacle_points;

 private:
  [[nodiscard]] double coordinate(const std::vector<std::uint8_t>& bytes, std::size_t first,
                                  std::size_t c) const {
    return lower[c] + (upper[c] - lower[c]) / 65535 * little_endian(bytes, first + c, 2);
  }
};

HtmlView view_of(const std::string& path, const HtmlViewOptions& options = {}) {
  return html_view(RunReader(path), options);
}

// --- the tests

TEST(HtmlView, DecodesToTheRunWithinItsQuantisation) {
  const test::Scratch scratch;
  const auto mesh = test::tet_cube(3);
  write_run(mesh, scratch / "run.h5", 9);
  const auto view = view_of(scratch / "run.h5");
  EXPECT_EQ(view.frames, 9U);
  EXPECT_EQ(view.triangles, 108U);
  EXPECT_FALSE(view.cut_to_size);

  const auto surface = surface_of(mesh);
  EXPECT_EQ(fact(view.page, "nodes"), 64);
  EXPECT_EQ(fact(view.page, "cells"), 162);
  EXPECT_EQ(fact(view.page, "vertices"), 56);
  const Decoded page(view.page);
  ASSERT_EQ(page.triangles.size(), 108U * 3 * 4);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(little_endian(page.triangles, 3 * t + i, 4), surface.triangles[t][i]);

  ASSERT_EQ(page.frames.size(), 9U);
  for (std::size_t f = 0; f < 9; ++f) {
    const double time = interval * static_cast<double>(f);
    EXPECT_EQ(page.number(f), static_cast<double>(f));
    EXPECT_EQ(page.time(f), time);
    ASSERT_EQ(page.frames[f].size(), 56U * 8);
    for (std::size_t v = 0; v < surface.nodes.size(); ++v) {
      const auto expected = moved(mesh.nodes[static_cast<std::size_t>(surface.nodes[v])], time);
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(page.position(f, v, c), expected[c], 0.51 * (page.upper[c] - page.lower[c]) / 65535);
    }
  }
}

TEST(HtmlView, ShowsTheSmallestStretchAndTheShareOfInvertedCells) {
  const test::Scratch scratch;
  const auto mesh = test::tet_cube(2);
  write_run(mesh, scratch / "run.h5", 9);
  const Decoded page(view_of(scratch / "run.h5").page);
  const auto surface = surface_of(mesh);
  for (std::size_t f = 0; f < 9; ++f) {
    std::vector<double> per_cell(48);
    for (std::size_t cell = 0; cell < 48; ++cell)
      per_cell[cell] = stretch_of(cell, interval * static_cast<double>(f));
    const auto expected = smallest_at_vertices(surface, per_cell);
    for (std::size_t v = 0; v < expected.size(); ++v) {
      EXPECT_NEAR(page.stretch(f, v), std::max(expected[v], -1.0), 1.0 / 32767);
      EXPECT_EQ(page.stretch(f, v) < 0, expected[v] < 0) << expected[v];
    }
    const auto inverted = std::ranges::count_if(per_cell, [](double s) { return s < 0; });
    EXPECT_EQ(page.inverted(f), static_cast<double>(inverted) / 48);
  }
}

TEST(HtmlView, ShowsWhereCellsAreInvertedInside) {
  const test::Scratch scratch;
  const auto mesh = test::tet_cube(2);
  write_run(mesh, scratch / "run.h5", 9);
  const Decoded page(view_of(scratch / "run.h5").page);
  const auto& nodes = mesh.cells.front().nodes;
  for (std::size_t f = 0; f < 9; ++f) {
    const double time = interval * static_cast<double>(f);
    std::vector<Vec3d> expected;
    for (std::size_t cell = 0; cell < 48; ++cell) {
      if (stretch_of(cell, time) >= 0) continue;
      Vec3d centre{};
      for (std::size_t i = 0; i < 4; ++i)
        centre += 0.25 * moved(mesh.nodes[static_cast<std::size_t>(nodes[4 * cell + i])], time);
      expected.push_back(centre);
    }
    const auto stride = (expected.size() + 25) / 26;  // no more dots than vertices
    ASSERT_EQ(page.dot_count(f), expected.empty() ? 0 : (expected.size() + stride - 1) / stride);
    for (std::size_t dot = 0; dot < page.dot_count(f); ++dot)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(page.dot(f, dot, c), expected[dot * stride][c],
                    0.51 * (page.upper[c] - page.lower[c]) / 65535);
  }
  EXPECT_EQ(page.dot_count(0), 0U);
  EXPECT_GT(page.dot_count(7), 0U);
  EXPECT_LT(page.dot_count(7), 26U);
  EXPECT_EQ(page.dot_count(8), 21U);  // every second of 41
}

TEST(HtmlView, KeepsTheSignOfTheTiniestStretch) {
  const test::Scratch scratch;
  const auto mesh = test::single_tet();
  const auto distributed = distribute(MPI_COMM_SELF, mesh);
  const NodeField field(distributed);
  FrameWriter writer(distributed, scratch / "run.h5", {});
  for (const double stretch : {-1e-300, -0.0, 0.0, 1e-300, -1e300, 1e300})
    writer.write(
        {0, 0, field, field, [&](std::size_t, std::span<double> per_cell) { per_cell[0] = stretch; }});
  const Decoded page(view_of(scratch / "run.h5").page);
  const std::vector<double> expected{-1.0 / 32767, 0, 0, 0, -1, 1};
  for (std::size_t f = 0; f < expected.size(); ++f) EXPECT_DOUBLE_EQ(page.stretch(f, 0), expected[f]) << f;
}

TEST(HtmlView, FallsBackOnTheFlagsAndThenOnNoColours) {
  const test::Scratch scratch;
  const auto colouring = [&](const FrameFields& fields) {
    write_run(test::tet_cube(2), scratch / "run.h5", 9, fields);
    return between(script_of(view_of(scratch / "run.h5").page, "facts"), "\"colouring\": \"", "\"");
  };
  EXPECT_EQ(colouring({}), "min_stretch");
  EXPECT_EQ(colouring({.min_stretch = false}), "inverted");
  EXPECT_EQ(colouring({.min_stretch = false, .inversion = false}), "none");
}

TEST(HtmlView, SpreadsTheFramesItShowsEvenly) {
  const test::Scratch scratch;
  write_run(test::tet_cube(1), scratch / "run.h5", 21);
  const auto view = view_of(scratch / "run.h5", {.max_frames = 6});
  EXPECT_EQ(view.frames, 6U);
  EXPECT_FALSE(view.cut_to_size);
  const Decoded page(view.page);
  for (std::size_t f = 0; f < 6; ++f) EXPECT_EQ(page.number(f), 4.0 * static_cast<double>(f));
  EXPECT_EQ(Decoded(view_of(scratch / "run.h5", {.max_frames = 1}).page).number(0), 0);
}

TEST(HtmlView, StaysWithinItsSize) {
  const test::Scratch scratch;
  write_run(test::tet_cube(4), scratch / "run.h5", 40);
  const auto whole = view_of(scratch / "run.h5");
  const auto limit = whole.page.size() - 20'000;
  const auto cut = view_of(scratch / "run.h5", {.max_bytes = limit});
  EXPECT_TRUE(cut.cut_to_size);
  EXPECT_LE(cut.page.size(), limit);
  const Decoded page(cut.page);
  EXPECT_EQ(page.number(0), 0);
  EXPECT_EQ(page.number(cut.frames - 1), 39);
  EXPECT_EQ(view_of(scratch / "run.h5", {.max_bytes = 1}).frames, 1U);
}

TEST(HtmlView, TurnsTheAxisThatPointsUp) {
  const test::Scratch scratch;
  write_run(test::tet_cube(2), scratch / "run.h5", 9);
  const auto heights = [&](std::size_t up) {
    const Decoded page(view_of(scratch / "run.h5", {.up = up}).page);
    return std::pair(page.lower[1], page.upper[1]);
  };
  EXPECT_EQ(heights(0), std::pair(0.0, 1.1));
  EXPECT_EQ(heights(1), std::pair(-0.5, 1.0));
  EXPECT_EQ(heights(2), std::pair(0.0, 2.0));
}

TEST(HtmlView, DrawsTheGroundWhereTheBodyStandsAtHeightZero) {
  const test::Scratch scratch;
  write_run(test::tet_cube(2), scratch / "run.h5", 9);
  EXPECT_EQ(fact(view_of(scratch / "run.h5", {.up = 2}).page, "ground"), 1);
  EXPECT_EQ(fact(view_of(scratch / "run.h5", {.up = 1}).page, "ground"), 0);  // sinks to -0.5 m
}

TEST(HtmlView, NeedsNoNetworkAndLeavesNothingUnfilled) {
  const test::Scratch scratch;
  write_run(test::mixed_row(3), scratch / "run.h5", 2);
  const auto page = view_of(scratch / "run.h5", {.title = "<b> & \"run\" </title>"}).page;
  EXPECT_NE(page.find("<title>&lt;b&gt; &amp; \"run\" &lt;/title&gt;</title>"), std::string::npos);
  for (const auto* foreign : {"http:", "https:", "src=", "<link", "import ", "fetch(", "{{"})
    EXPECT_EQ(page.find(foreign), std::string::npos) << foreign;
}

TEST(HtmlView, RefusesWhatCannotBeShown) {
  const test::Scratch scratch;
  write_run(test::tet_cube(1), scratch / "empty.h5", 0);
  EXPECT_EQ(test::user_error_of([&] { static_cast<void>(view_of(scratch / "empty.h5")); }),
            "'" + (scratch / "empty.h5") + "' has no frames to show");

  const auto distributed = distribute(MPI_COMM_SELF, test::single_tet());
  NodeField positions(distributed);
  positions.owned()[4] = std::nan("");
  FrameWriter(distributed, scratch / "nan.h5", {.min_stretch = false, .inversion = false})
      .write({0, 0, positions, positions, {}});
  EXPECT_EQ(test::user_error_of([&] { static_cast<void>(view_of(scratch / "nan.h5")); }),
            "frame 0 of '" + (scratch / "nan.h5") + "' has a node at nan m, which cannot be shown");
}

TEST(HtmlView, RefusesToSimplifyToNothing) {
  const test::Scratch scratch;
  write_run(test::tet_cube(2), scratch / "run.h5", 1);
  EXPECT_EQ(
      test::user_error_of([&] { static_cast<void>(view_of(scratch / "run.h5", {.max_triangles = 1})); }),
      "nothing of the surface of '" + (scratch / "run.h5") +
          "' is left with at most 1 triangles: it must be more");
}

TEST(HtmlView, RefusesAFileThatIsNoRunOrIsCutShort) {
  const test::Scratch scratch;
  EXPECT_NE(test::user_error_of([&] { static_cast<void>(view_of(scratch / "nowhere.h5")); }), "");
  write_run(test::tet_cube(2), scratch / "run.h5", 3);
  const auto whole = fs::file_size(scratch / "run.h5");
  for (int tenth = 0; tenth < 10; ++tenth) {
    fs::copy_file(scratch / "run.h5", scratch / "cut.h5", fs::copy_options::overwrite_existing);
    fs::resize_file(scratch / "cut.h5", whole * static_cast<std::uintmax_t>(tenth) / 10);
    EXPECT_NE(test::user_error_of([&] { static_cast<void>(view_of(scratch / "cut.h5")); }), "") << tenth;
  }
}

TEST(HtmlView, ShowsObstaclesThatHaveAnEnd) {
  const test::Scratch scratch;
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  obstacles.push_back(std::make_unique<Obstacle>(
      "ball", 0.1, std::make_unique<Sphere>(0.5),
      std::make_unique<UniformMotion>(RigidState{.origin = {0, 2, 0}, .velocity = {4, 0, 0}})));
  obstacles.push_back(std::make_unique<Obstacle>("ground", 0.1,
                                                 std::make_unique<HalfSpace>(Vec3d{}, Vec3d{0, 1, 0}),
                                                 std::make_unique<UniformMotion>(RigidState{})));
  write_run(test::tet_cube(2), scratch / "run.h5", 3, {}, obstacles);
  const Decoded page(view_of(scratch / "run.h5", {}).page);
  const auto ball = RunReader(scratch / "run.h5").obstacle_points(0, {.name = "ball", .triangles = {}});
  ASSERT_EQ(page.frames.size(), 3U);
  for (std::size_t f = 0; f < 3; ++f) {
    const auto& bytes = page.obstacle_points[f];
    ASSERT_EQ(bytes.size(), 12 * ball.size()) << "the ball, and nothing of the ground";
    for (std::size_t i = 0; i < ball.size(); ++i) {
      const auto number = [&](std::size_t c) {
        return std::bit_cast<float>(little_endian(bytes, 3 * i + c, 4));
      };
      const Vec3d off{number(0) - 0.5 * static_cast<double>(f), number(1) - 2.0, number(2)};
      EXPECT_NEAR(norm(off), 0.5, 0.01);
    }
  }
}

}  // namespace
}  // namespace evert
