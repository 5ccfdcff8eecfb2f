#include "shape_table.hpp"
#include "tables.hpp"
#include <cmath>
#include <functional>
#include <tuple>

/// What acts on the bodies: obstacles, constraints, events.
namespace evert {

using namespace schema;

namespace {

// --- constraints

const Table<BoxSelection>& box_selection_table() {
  static const auto table =
      Table<BoxSelection>("A box in the world.")
          .required("min", &BoxSelection::min, vector3("m"), "[-1, 0, -1]", "Lowest corner.")
          .required("max", &BoxSelection::max, vector3("m"), "[1, 0.1, 1]", "Highest corner.")
          .then([](BoxSelection& box, const Value& map, const std::string& path) {
            expect_ordered(box.min, box.max, map, path);
          });
  return table;
}

const Table<SphereSelection>& sphere_selection_table() {
  static const auto table =
      Table<SphereSelection>("A ball in the world.")
          .required("center", &SphereSelection::center, vector3("m"), "[0, 1, 0]", "Its centre.")
          .required("radius", &SphereSelection::radius, number("m", above(0)), "0.1", "Its radius.");
  return table;
}

const Table<NamedSelection>& select_by_name() {
  static const auto table = Table<NamedSelection>("Nodes by name.")
                                .required("node_set", &NamedSelection::node_set, text("name"), "x_min",
                                          "A named set of the mesh file, or of the generator.");
  return table;
}

const Table<BoxSelection>& select_by_box() {
  static const auto table = Table<BoxSelection>("Nodes by place.")
                                .required("box", std::identity{}, table_of(box_selection_table()),
                                          "{min: [-1, 0, -1], max: [1, 0.1, 1]}",
                                          "Nodes in a box, at rest after the body's transform.");
  return table;
}

const Table<SphereSelection>& select_by_sphere() {
  static const auto table = Table<SphereSelection>("Nodes by place.")
                                .required("sphere", std::identity{}, table_of(sphere_selection_table()),
                                          "{center: [0, 1, 0], radius: 0.1}",
                                          "Nodes in a ball, at rest after the body's transform.");
  return table;
}

/// [vx, vy, vz], or [[t, vx, vy, vz], ...] with times that increase.
Type<std::vector<VelocityKey>> velocity_over_time() {
  const auto constant = vector3("m/s");
  const auto rows = sequence_of(array_of<4>(number("s, m/s"), "numbers t, vx, vy, vz"));
  return {.info = {.name = "3 numbers, or list of: [t, vx, vy, vz]", .unit = "m/s"},
          .read =
              [=](const Value& value, const std::string& path) {
                if (value.kind != Value::Kind::list || value.items.empty() ||
                    value.items.front().kind != Value::Kind::list)
                  return std::vector<VelocityKey>{{0, constant.read(value, path)}};
                std::vector<VelocityKey> keys;
                for (const auto& row : rows.read(value, path)) {
                  if (!keys.empty() && !(row[0] > keys.back().time))
                    fail(value.items[keys.size()], path + "[" + std::to_string(keys.size()) + "]",
                         "has a time that is not later than that of the row before");
                  keys.push_back({row[0], Vec3d{{row[1], row[2], row[3]}}});
                }
                return keys;
              },
          .write = [](const std::vector<VelocityKey>&) { return std::string(); }};
}

/// An obstacle either moves as the scene says, or has a mass.
void finish_obstacle(ObstacleConfig& obstacle, const Value& map, const std::string& path) {
  const auto exclude = [&](const char* one, const char* other, const std::string& advice) {
    if (map.find(one) != nullptr && map.find(other) != nullptr)
      fail(*map.find(other), join(path, other), std::string("excludes '") + one + "'" + advice);
  };
  exclude("velocity", "motion", ": write 'motion: {velocity: ...}'");
  exclude("density", "mass", "");
  for (const char* mass : {"mass", "density"})
    for (const char* motion : {"velocity", "motion"})
      exclude(motion, mass, ": what has a mass moves by the forces on it, from 'initial_velocity' on");
  for (const char* mass : {"mass", "density"}) exclude("until", mass, ": what has a mass stays");
  const bool rigid_body = obstacle.mass || obstacle.density;
  for (const char* mass : {"mass", "density"})
    if (map.find(mass) != nullptr && std::holds_alternative<HalfSpaceShape>(obstacle.shape.solid))
      fail(*map.find(mass), join(path, mass), "is not possible: a half_space goes on for ever");
  for (const char* key : {"initial_velocity", "initial_angular_velocity"})
    if (map.find(key) != nullptr && !rigid_body)
      fail(*map.find(key), join(path, key), "goes with 'mass' or 'density' only");
}

void finish_constraint(ConstraintConfig& constraint, const Value& map, const std::string& path) {
  const auto* fixed = map.find("fixed");
  if (fixed != nullptr && !constraint.fixed)
    fail(*fixed, join(path, "fixed"),
         "must be true where it is given; leave the constraint out to let the nodes go");
  if (constraint.fixed != constraint.velocity.empty())
    fail(map, path, "needs either 'fixed: true' or 'velocity'");
  if (constraint.fixed) constraint.velocity = {VelocityKey{}};
  const auto& axes = constraint.axes;
  if (!axes[0] && !axes[1] && !axes[2])
    fail(*map.find("axes"), join(path, "axes"), "constrains nothing: one of the three must be true");
  if (!(constraint.until > constraint.from)) fail(map, path, "'until' must be later than 'from'");
}

}  // namespace

const Table<ObstacleConfig>& obstacle_table() {
  static const auto table = [] {
    Table<ObstacleConfig> keys("A rigid obstacle that all bodies collide with.");
    add_shape_keys(keys);
    return keys
        .optional("friction", &ObstacleConfig::friction, friction_type(), "0.3", "Coulomb coefficient.")
        .optional("velocity", &ObstacleConfig::velocity, vector3("m/s"), "[0, -1, 0]", "Constant.")
        .optional("motion", &ObstacleConfig::motion, table_of(motion_table()),
                  "{angular_velocity: [0, 0, 2]}", "Any other motion, in the place of velocity.")
        .either("until", &ObstacleConfig::until, number("s", above(0)), "2",
                "It is taken away then; without it, never.")
        .either("mass", &ObstacleConfig::mass, number("kg", above(0)), "5",
                "With a mass it is a rigid body: gravity, nodes and other obstacles move it.")
        .either("density", &ObstacleConfig::density, number("kg/m^3", above(0)), "1000",
                "Instead of mass, times the volume of the shape.")
        .optional("initial_velocity", &ObstacleConfig::initial_velocity, vector3("m/s"), "[0, -1, 0]",
                  "Of a rigid body with mass, of its centre of mass.")
        .optional("initial_angular_velocity", &ObstacleConfig::initial_angular_velocity, vector3("rad/s"),
                  "[0, 0, 5]", "Of a rigid body with mass.")
        .then(finish_obstacle);
  }();
  return table;
}

const Table<ConstraintConfig>& constraint_table() {
  static const auto table =
      Table<ConstraintConfig>("Nodes whose velocity is prescribed.")
          .required("body", &ConstraintConfig::body_name, text("name"), "torus",
                    "The body whose nodes are meant.")
          .alternative_by_key("node_set", &ConstraintConfig::nodes, select_by_name())
          .alternative_by_key("box", &ConstraintConfig::nodes, select_by_box())
          .alternative_by_key("sphere", &ConstraintConfig::nodes, select_by_sphere())
          .either("fixed", &ConstraintConfig::fixed, yes_or_no(), "true", "The nodes do not move.")
          .either("velocity", &ConstraintConfig::velocity, velocity_over_time(),
                  "[[0, 0, 0, 0], [1, 0, 0.5, 0]]",
                  "Instead of fixed: a constant velocity, or a table of times and velocities, linear in "
                  "between and constant outside.")
          .optional("axes", &ConstraintConfig::axes, array_of<3>(yes_or_no(), "of true or false"),
                    "[true, false, true]", "Which components are prescribed.")
          .optional("from", &ConstraintConfig::from, number("s", at_least(0)), "0.5", "When it begins.")
          .either("until", &ConstraintConfig::until, number("s", above(0)), "1",
                  "When it ends; without it, never.")
          .then(finish_constraint);
  return table;
}

const Table<EventConfig>& event_table() {
  // `to` is read when the whole scene is known, by the type of what it sets (events.cpp).
  static const Type<Value> any{.info = {.name = "as the key that is set"},
                               .read = [](const Value& value, const std::string& /*path*/) { return value; },
                               .write = [](const Value&) { return std::string(); }};
  static const auto table =
      Table<EventConfig>("A value that changes at a time.")
          .required("at", &EventConfig::at, number("s", at_least(0)), "0.5", "When.")
          .required("set", &EventConfig::set, text("path"), "bodies.torus.material.youngs_modulus",
                    "What: youngs_modulus, poissons_ratio, lambda or mu of a material that has them, a "
                    "number of a damping that it has, "
                    "friction of an obstacle, or gravity.")
          .required(
              "to", [](EventConfig&) -> auto& { return std::ignore; }, any, "2e5", "The new value.");
  return table;
}

}  // namespace evert
