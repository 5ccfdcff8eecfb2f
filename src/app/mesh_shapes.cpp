#include "mesh_shapes.hpp"

#include "evert/core/error.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/shapes/solids.hpp"

#include "command_options.hpp"
#include <functional>
#include <map>
#include <vector>

namespace evert {
namespace {

/// A shape that can be generated: the options it takes besides -o, and what makes it of them.
struct Shape {
  std::string name;
  std::vector<std::string> options;
  std::function<Mesh(const CommandOptions&)> make;
};

BoxCells box_cells(const std::string& name) {
  const std::map<std::string, BoxCells> kinds{{"bcc", BoxCells::bcc},
                                              {"tet5", BoxCells::tet5},
                                              {"tet6", BoxCells::tet6},
                                              {"hex8", BoxCells::hex8},
                                              {"wedge6", BoxCells::wedge6}};
  if (const auto found = kinds.find(name); found != kinds.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, kind] : kinds) names.push_back(known);
  throw UserError("evert mesh generate box: there is no cell '" + name + "': must be " + list_of(names) +
                  did_you_mean(name, names));
}

Mesh make_box(const CommandOptions& options) {
  const auto cells = options.has("cell") ? box_cells(options.text("cell")) : BoxCells::bcc;
  if (options.has("cells") == options.has("edge_length"))
    throw UserError("evert mesh generate box needs either -edge_length or -cells");
  const auto size = options.three_numbers("size");
  if (options.has("edge_length")) {
    if (options.has("hole")) throw UserError("evert mesh generate box: -hole needs -cells");
    return generate_box(size, options.number("edge_length"), cells);
  }
  const auto hole = options.has("hole") ? options.two_whole_numbers("hole") : std::array<int, 2>{};
  return generate_box(size, options.three_whole_numbers("cells"), cells, hole);
}

/// A shape filled by stuffing: all take -edge_length.
template <class MakeSolid>
Shape implicit(const std::string& name, std::vector<std::string> options, MakeSolid make_solid) {
  options.emplace_back("edge_length");
  return {name, std::move(options), [name, make_solid](const CommandOptions& values) {
            return generate(make_solid(values), name, values.number("edge_length"));
          }};
}

const std::vector<Shape>& shapes() {
  using Options = CommandOptions;
  static const std::vector<Shape> table{
      {"box", {"size", "edge_length", "cells", "hole", "cell"}, make_box},
      implicit("ball", {"radius"}, [](const Options& o) { return Sphere(o.number("radius")); }),
      implicit("torus", {"major_radius", "minor_radius"},
               [](const Options& o) { return Torus(o.number("major_radius"), o.number("minor_radius")); }),
      implicit("cylinder", {"radius", "length"},
               [](const Options& o) { return cylinder(o.number("radius"), o.number("length")); }),
      implicit("capsule", {"radius", "length"},
               [](const Options& o) { return Capsule(o.number("radius"), o.number("length")); }),
      implicit("ellipsoid", {"radii"}, [](const Options& o) { return Ellipsoid(o.three_numbers("radii")); }),
  };
  return table;
}

}  // namespace

GenerateRequest generate_mesh(std::span<const std::string> arguments) {
  std::vector<std::string> names;
  for (const auto& shape : shapes()) names.push_back(shape.name);
  if (arguments.empty() || arguments.front().starts_with('-'))
    throw UserError("evert mesh generate needs a shape: " + list_of(names));
  for (const auto& shape : shapes()) {
    if (shape.name != arguments.front()) continue;
    auto with_value = shape.options;
    with_value.emplace_back("o");
    const CommandOptions options("evert mesh generate " + shape.name, arguments.subspan(1), with_value, {},
                                 {});
    auto output = options.text("o");
    const auto format = mesh_format_of(output);  // before the work
    return {shape.make(options), std::move(output), format};
  }
  throw UserError("evert mesh generate: there is no shape '" + arguments.front() + "': must be " +
                  list_of(names) + did_you_mean(arguments.front(), names));
}

}  // namespace evert
