#include "surface_builder.hpp"
#include <charconv>
#include <vector>

// Wavefront, OFF and STL; PLY is in ply_reader.cpp.
namespace evert {
namespace {

Vec3d read_point(InputCursor& in) {
  Vec3d point{};
  for (auto& coordinate : point.components) coordinate = in.real("a coordinate");
  return point;
}

/// "7", "7/2", "7//3" or "-1": the number of a point from 1 on, or from the last one back.
std::int64_t obj_corner(std::string_view word, const InputCursor& in, std::int64_t points) {
  std::int64_t number = 0;
  const auto digits = word.substr(0, word.find('/'));
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (result.ec != std::errc() || result.ptr != digits.data() + digits.size() || number == 0)
    in.fail("'" + std::string(word.substr(0, 20)) +
            "' is no corner of a face: must be a number like 3 or 3/1/2");
  return number > 0 ? number - 1 : points + number;
}

}  // namespace

void read_obj(InputCursor& in, SurfaceBuilder& surface) {
  in.set_comment('#');
  std::vector<std::int64_t> corners;
  while (!in.at_end()) {
    const auto keyword = in.word("a keyword");
    if (keyword == "v") {
      surface.add_point(read_point(in));
    } else if (keyword == "f") {
      auto line = in.rest_of_line();
      line = line.substr(0, line.find('#'));
      corners.clear();
      constexpr std::string_view blanks = " \t\r";
      for (auto begin = line.find_first_not_of(blanks); begin != std::string_view::npos;
           begin = line.find_first_not_of(blanks, begin)) {
        const auto end = std::min(line.find_first_of(blanks, begin), line.size());
        corners.push_back(obj_corner(line.substr(begin, end - begin), in, surface.point_count()));
        begin = end;
      }
      surface.add_polygon(corners);
      continue;
    }
    in.rest_of_line();
  }
}

void read_off(InputCursor& in, SurfaceBuilder& surface) {
  in.set_comment('#');
  if (in.word("OFF") != "OFF") in.fail("must begin with OFF");
  constexpr std::size_t shortest_point = 6, shortest_face = 8;  // characters
  const auto points = in.count("the number of points", shortest_point);
  const auto faces = in.count("the number of faces", shortest_face);
  (void)in.integer("the number of edges");
  for (GlobalIndex p = 0; p < points; ++p) {
    surface.add_point(read_point(in));
    in.rest_of_line();
  }
  std::vector<std::int64_t> corners;
  for (GlobalIndex f = 0; f < faces; ++f) {
    const auto count = in.count("the number of corners", 2);
    corners.clear();
    for (GlobalIndex k = 0; k < count; ++k) corners.push_back(in.integer("the number of a point"));
    surface.add_polygon(corners);
    in.rest_of_line();  // a colour
  }
}

namespace {

void expect_word(InputCursor& in, std::string_view expected) {
  const std::string wanted(expected);
  if (in.word(wanted) != expected) in.fail("must be '" + wanted + "' here");
}

void add_triangle(SurfaceBuilder& surface) {
  const auto last = surface.point_count();
  surface.add_polygon(std::array<std::int64_t, 3>{last - 3, last - 2, last - 1});
}

void read_ascii_stl(InputCursor& in, SurfaceBuilder& surface) {
  in.rest_of_line();  // solid and its name
  while (true) {
    const auto keyword = in.word("facet or endsolid");
    if (keyword == "endsolid") break;
    if (keyword != "facet") in.fail("must be 'facet' or 'endsolid' here");
    in.rest_of_line();  // the normal, which the corners say better
    expect_word(in, "outer");
    expect_word(in, "loop");
    for (int k = 0; k < 3; ++k) {
      expect_word(in, "vertex");
      surface.add_point(read_point(in));
    }
    add_triangle(surface);
    expect_word(in, "endloop");
    expect_word(in, "endfacet");
  }
}

constexpr std::size_t stl_header = 84, stl_triangle = 50;  // bytes

void read_binary_stl(InputCursor& in, SurfaceBuilder& surface) {
  constexpr bool swap = std::endian::native != std::endian::little;
  (void)in.bytes(stl_header - sizeof(std::uint32_t), "the header");
  const auto count = in.plausible_count(in.binary<std::uint32_t>("the number of triangles", swap),
                                        "triangles", stl_triangle);
  for (GlobalIndex t = 0; t < count; ++t) {
    (void)in.bytes(3 * sizeof(float), "a normal");
    for (int k = 0; k < 3; ++k) {
      Vec3d point{};
      for (auto& coordinate : point.components) coordinate = in.binary<float>("a coordinate", swap);
      if (!std::isfinite(norm(point))) in.fail("a coordinate is not finite");
      surface.add_point(point);
    }
    add_triangle(surface);
    (void)in.bytes(sizeof(std::uint16_t), "the end of a triangle");
  }
}

/// Binary files may begin with "solid", too; what their length says is surer.
bool is_binary_stl(std::string_view text) {
  if (text.size() < stl_header) return false;
  InputCursor in(text, "");
  (void)in.bytes(stl_header - sizeof(std::uint32_t), "the header");
  const auto count =
      in.binary<std::uint32_t>("the number of triangles", std::endian::native != std::endian::little);
  return text.size() == stl_header + stl_triangle * count || !text.starts_with("solid");
}

}  // namespace

void read_stl(InputCursor& in, SurfaceBuilder& surface) {
  if (is_binary_stl(in.rest())) return read_binary_stl(in, surface);
  if (in.peek_word() != "solid") in.fail("is no STL file: must begin with 'solid', or be binary");
  read_ascii_stl(in, surface);
}

}  // namespace evert
