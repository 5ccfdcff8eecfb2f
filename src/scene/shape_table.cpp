#include "shape_table.hpp"

#include "evert/core/error.hpp"

#include "solid.hpp"
#include "tables.hpp"
#include <functional>
#include <type_traits>

/// The shapes of obstacles and of generated meshes: every shape once.
namespace evert {

using namespace schema;

namespace {

Type<double> length() { return number("m", above(0)); }

// --- the keys of each shape. S is the shape, or the shape with an edge length.

template <class S>
Table<S> keys(const HalfSpaceShape& /*shape*/) {
  return Table<S>("Everything behind a plane.")
      .optional("normal", &S::normal, direction(), "[0, 1, 0]", "Of the plane, out of the solid.")
      .either("point", &S::point, vector3("m"), "[0, 0, 0]",
              "Any point of the plane; the origin unless given.")
      .either("offset", &S::offset, number("m"), "0",
              "Instead of point: the plane's distance from the origin along normal.")
      .then([](S& plane, const Value& map, const std::string& path) {
        if (map.find("offset") == nullptr) {
          plane.offset = dot(plane.normal, plane.point);
          return;
        }
        if (map.find("point") != nullptr) fail(map, path, "'point' and 'offset' exclude each other");
        plane.point = plane.offset * plane.normal;
      });
}

template <class S>
Table<S> keys(const SphereShape& /*shape*/) {
  return Table<S>("A ball.").required("radius", &S::radius, length(), "0.5", "Its radius.");
}

template <class S>
Table<S> keys(const BoxShape& /*shape*/) {
  return Table<S>("A box with edges along the axes.")
      .required("size", &S::size, vector3("m", above(0)), "[1, 0.5, 0.5]", "Lengths of the edges.");
}

template <class S>
Table<S> keys(const RoundedBoxShape& /*shape*/) {
  return Table<S>("A box with round edges and corners.")
      .required("size", &S::size, vector3("m", above(0)), "[1, 0.5, 0.5]", "Lengths from side to side.")
      .required("rounding", &S::rounding, length(), "0.1",
                "Radius of the edges and corners; less than half the shortest side.");
}

template <class S>
Table<S> keys(const EllipsoidShape& /*shape*/) {
  return Table<S>("An ellipsoid.")
      .required("radii", &S::radii, vector3("m", above(0)), "[0.5, 0.3, 0.3]", "Along x, y and z.");
}

template <class S>
Table<S> keys(const CapsuleShape& /*shape*/) {
  return Table<S>("A cylinder around the y axis with a half ball at both ends.")
      .required("radius", &S::radius, length(), "0.2", "Of the cylinder and the half balls.")
      .required("length", &S::length, length(), "1", "Of the cylinder alone.");
}

template <class S>
Table<S> keys(const CylinderShape& /*shape*/) {
  return Table<S>("A cylinder around the y axis.")
      .required("radius", &S::radius, length(), "0.2", "Its radius.")
      .required("length", &S::length, length(), "1", "Along the y axis.");
}

template <class S>
Table<S> keys(const TorusShape& /*shape*/) {
  return Table<S>("A torus around the y axis.")
      .required("major_radius", &S::major_radius, length(), "0.5", "From the axis to the middle of the tube.")
      .required("minor_radius", &S::minor_radius, length(), "0.2", "Of the tube; less than major_radius.");
}

template <class S>
Table<S> keys(const ConeShape& /*shape*/) {
  return Table<S>("A cone around the y axis, its tip upwards or cut off.")
      .required("bottom_radius", &S::bottom_radius, number("m", at_least(0)), "0.5", "At -length/2.")
      .optional("top_radius", &S::top_radius, number("m", at_least(0)), "0.2",
                "At length/2; one of the two radii is more than 0.")
      .required("length", &S::length, length(), "1", "Along the y axis.");
}

template <class S>
Table<S> keys(const GearShape& /*shape*/) {
  return Table<S>("A spur gear around the y axis, a tooth on the x axis; its flanks are nearly involutes.")
      .required("teeth", &S::teeth, integer(3, 10000), "12", "Their number.")
      .required("root_radius", &S::root_radius, length(), "0.3", "From the axis to the bottom of a gap.")
      .required(
          "tip_radius", &S::tip_radius, length(), "0.4",
          "From the axis to the top of a tooth; more than root_radius. Two gears mesh at the distance of "
          "both their radii halfway between root and tip, one turned by half a tooth.")
      .required("width", &S::width, length(), "0.2", "Along the axis.");
}

template <class S>
Table<S> keys(const FigureShape& /*shape*/) {
  return Table<S>(
             "A figure that stands upright, arms outstretched, with thin limbs, fingers, feet and a nose.")
      .optional("height", &S::height, length(), "1.8", "From the soles to the top of the head.");
}

template <class S>
Table<S> keys(const MeshShape& /*shape*/) {
  return Table<S>("What a closed surface of triangles encloses.")
      .required(
          "surface", &S::surface, text("path"), "hook.stl",
          "Wavefront (.obj), STL (.stl), PLY (.ply) or OFF (.off), closed and without self-intersection. "
          "Relative to the scene file; in -set, to the working directory.")
      .optional("scale", &S::scale, number("-", above(0)), "0.001",
                "Its lengths are multiplied by it: 0.001 for a file in millimetres.");
}

/// Of a part of another shape, itself a shape: there before its keys are.
Table<ShapeConfig>& part_table() {
  static Table<ShapeConfig> table("A shape.");
  return table;
}

template <class S>
Table<S> keys_of_parts(const std::string& help) {
  return Table<S>(help)
      .required("of", &S::of, sequence_of(table_of(part_table())),
                "[{shape: box, size: [1, 1, 1]}, {shape: sphere, radius: 0.6}]",
                "The parts, each with the keys of a shape.")
      .then([](S& shape, const Value& map, const std::string& path) {
        if (shape.of.empty()) fail(*map.find("of"), join(path, "of"), "must have at least one part");
      });
}

template <class S>
Table<S> keys(const UnionShape& /*shape*/) {
  return keys_of_parts<S>("What is in any of the parts.");
}

template <class S>
Table<S> keys(const IntersectionShape& /*shape*/) {
  return keys_of_parts<S>("What is in all of the parts.");
}

template <class S>
Table<S> keys(const DifferenceShape& /*shape*/) {
  return keys_of_parts<S>("The first part without the others.");
}

// --- the list of shapes

/// Calls visit(name, shape) for every shape.
template <class Visit>
void for_each_shape(Visit&& visit) {
  visit("half_space", HalfSpaceShape{});
  visit("sphere", SphereShape{});
  visit("box", BoxShape{});
  visit("rounded_box", RoundedBoxShape{});
  visit("ellipsoid", EllipsoidShape{});
  visit("capsule", CapsuleShape{});
  visit("cylinder", CylinderShape{});
  visit("torus", TorusShape{});
  visit("cone", ConeShape{});
  visit("gear", GearShape{});
  visit("figure", FigureShape{});
  visit("mesh", MeshShape{});
  visit("union", UnionShape{});
  visit("intersection", IntersectionShape{});
  visit("difference", DifferenceShape{});
}

template <class Shape>
const Table<Shape>& table_of_shape() {
  static const auto table = keys<Shape>(Shape{});
  return table;
}

ShapeConfig& shape_in(ShapeConfig& shape) { return shape; }
const ShapeConfig& shape_in(const ShapeConfig& shape) { return shape; }
ShapeConfig& shape_in(ObstacleConfig& obstacle) { return obstacle.shape; }
const ShapeConfig& shape_in(const ObstacleConfig& obstacle) { return obstacle.shape; }

/// What is wrong with the shape as a whole, at the place where it is written; that of a file is known later.
void check_shape(const ShapeConfig& shape, const Value& map, const std::string& path) {
  if (std::holds_alternative<HalfSpaceShape>(shape.solid))
    for (const auto* key : {"center", "rotate", "grow"})
      if (const auto* value = map.find(key))
        fail(*value, join(path, key), "does not go with 'shape: half_space': 'normal' and 'point' place it");
  if (names_file(shape.solid)) return;
  try {
    (void)make_solid(shape, {});
  } catch (const UserError& error) {
    fail(map, path, error.what());
  }
}

template <class S>
void add_shape_keys_to(Table<S>& table) {
  table.chosen_by("shape", "Its shape.");
  for_each_shape([&]<class Shape>(const char* name, Shape /*shape*/) {
    table.alternative(
        name, [](S & owner) -> auto& { return shape_in(owner).solid; }, table_of_shape<Shape>());
  });
  table
      .optional(
          "center", [](auto& owner) -> auto& { return shape_in(owner).center; }, vector3("m"), "[0, 1, 0]",
          "Where the middle of the shape is.")
      .optional(
          "rotate", [](auto& owner) -> auto& { return shape_in(owner).rotate; }, table_of(rotation_table()),
          "{axis: [1, 0, 0], angle: 90}", "How the shape is turned about its middle.")
      .optional(
          "grow", [](auto& owner) -> auto& { return shape_in(owner).grow; }, number("m"), "0.01",
          "By how much the surface is moved outwards, which makes outer edges round; negative: inwards.")
      .then([](S& owner, const Value& map, const std::string& path) {
        check_shape(shape_in(owner), map, path);
      });
}

// --- filled with tetrahedra

template <class Shape>
struct Filled : Shape {
  double edge_length = 0;

  operator FilledShape() const { return {static_cast<const Shape&>(*this), edge_length}; }
};

/// A lattice of more cubes fits into no memory.
constexpr double most_cubes = 1e9;

void check_filled(const FilledShape& filled, const Value& map, const std::string& path) {
  if (names_file(filled.solid)) return;
  double cubes = 1;
  try {
    const auto box = make_solid({.solid = filled.solid}, {})->bounds();
    for (std::size_t k = 0; k < 3; ++k) cubes *= (box.upper[k] - box.lower[k]) / filled.edge_length;
  } catch (const UserError& error) {
    fail(map, path, error.what());
  }
  const auto& edge = *map.find("edge_length");
  if (!(cubes <= most_cubes))
    fail(edge, join(path, "edge_length"),
         shown(edge) + " is too short for this size: it makes more than 1e9 cells");
}

template <class Shape>
const Table<Filled<Shape>>& filled_table() {
  using S = Filled<Shape>;
  static const auto table =
      keys<S>(Shape{})
          .required("edge_length", &S::edge_length, length(), "0.05", "Edge of the tetrahedra, about.")
          .then(
              [](S& filled, const Value& map, const std::string& path) { check_filled(filled, map, path); });
  return table;
}

/// The parts of parts.
void fill_part_table() {
  static const bool is_filled = (add_shape_keys_to(part_table()), true);
  (void)is_filled;
}

}  // namespace

void add_shape_keys(Table<ObstacleConfig>& table) {
  fill_part_table();
  add_shape_keys_to(table);
}

void add_filled_shapes(Table<MeshConfig>& table) {
  fill_part_table();
  for_each_shape([&]<class Shape>(const std::string& name, Shape /*shape*/) {
    // a half-space has no end, and a box can do better than to be stuffed: BoxMesh
    constexpr bool is_filled = !std::is_same_v<Shape, HalfSpaceShape> && !std::is_same_v<Shape, BoxShape>;
    if constexpr (is_filled)
      table.alternative(name == "sphere" ? "ball" : name, std::identity{}, filled_table<Shape>());
  });
}

std::string name_of(const SolidConfig& solid) {
  std::string found;
  for_each_shape([&]<class Shape>(const char* name, Shape /*shape*/) {
    if (std::holds_alternative<Shape>(solid)) found = name;
  });
  return found;
}

}  // namespace evert
