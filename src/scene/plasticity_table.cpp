#include "tables.hpp"
#include <cmath>
#include <functional>
#include <numbers>

/// Permanent deformation, and what it is to lead to.
namespace evert {

using namespace schema;

namespace {

const Table<MeshGoal>& mesh_goal() {
  static const auto table =
      Table<MeshGoal>("The shape of another mesh.")
          .required(
              "file", &MeshGoal::path, text("path"), "flat.msh",
              "A mesh file with the same nodes and cells in the same order, in the place of which only the "
              "nodes are elsewhere; the body's transform is done to it, too. Relative to the scene file.");
  return table;
}

const Table<DeformationGoal>& deformation_goal() {
  static const auto table = Table<DeformationGoal>("The deformation of every cell.")
                                .required("deformations", &DeformationGoal::path, text("path"), "goal.txt",
                                          "A text file with nine numbers for each cell, in the order of the "
                                          "mesh: the goal of F_p, row after "
                                          "row, before the body's transform. Relative to the scene file.");
  return table;
}

const Table<FlattenGoal>& flatten_goal() {
  static const auto table =
      Table<FlattenGoal>("A disk of the same volume.")
          .required("flatten", &FlattenGoal::factor, number("-", above(0)), "0.3",
                    "The goal is so many times as thick along the axis, and wider across it.")
          .optional("axis", &FlattenGoal::axis, direction(), "[0, 1, 0]", "Through the middle of the body.");
  return table;
}

Type<double> twist_rate() {
  return converted<double>(number("degrees/m"), "number",
                           [](double degrees, const Value& /*value*/, const std::string& /*path*/) {
                             return degrees * std::numbers::pi / 180;
                           });
}

const Table<TwistGoal>& twist_goal() {
  static const auto table =
      Table<TwistGoal>("A twist.")
          .required("twist", &TwistGoal::rate, twist_rate(), "90",
                    "About the axis through the middle of the body, by the right-hand rule.")
          .optional("axis", &TwistGoal::axis, direction(), "[0, 1, 0]", "Through the middle of the body.");
  return table;
}

const Table<BendGoal>& bend_goal() {
  static const auto table =
      Table<BendGoal>("A bend.")
          .required("bend", &BendGoal::curvature, number("1/m"), "2",
                    "The axis through the middle of the body becomes a circle of this curvature.")
          .optional("axis", &BendGoal::axis, direction(), "[1, 0, 0]", "Through the middle of the body.")
          .optional("towards", &BendGoal::towards, direction(), "[0, 1, 0]",
                    "Where the centre of the circle lies.")
          .then([](BendGoal& goal, const Value& map, const std::string& path) {
            const Vec3d across = goal.towards - dot(goal.towards, goal.axis) * goal.axis;
            if (!(norm(across) > 1e-6)) fail(map, path, "'towards' must not be along 'axis'");
            goal.towards = (1 / norm(across)) * across;
          });
  return table;
}

const Table<GoalConfig>& goal_table() {
  static const auto shape = [](auto& goal) -> auto& { return goal.shape; };
  static const auto table =
      Table<GoalConfig>("A shape that flow is led to: of what yields, the part that brings it nearer.")
          .alternative_by_key("file", shape, mesh_goal())
          .alternative_by_key("deformations", shape, deformation_goal())
          .alternative_by_key("flatten", shape, flatten_goal())
          .alternative_by_key("twist", shape, twist_goal())
          .alternative_by_key("bend", shape, bend_goal())
          .optional(
              "strength", &GoalConfig::strength, number("1/s", at_least(0)), "5",
              "Rate at which the body approaches its goal by itself, also where nothing yields; 0: only what "
              "yields flows.")
          .optional("from", &GoalConfig::from, number("s", at_least(0)), "0.5", "Flow is free before.")
          .either("until", &GoalConfig::until, number("s", above(0)), "2",
                  "Flow is free from then on; without it, never.")
          .then([](GoalConfig& goal, const Value& map, const std::string& path) {
            if (goal.until > goal.from) return;
            const auto& value = *map.find("until");
            fail(value, join(path, "until"), shown(value) + " is not allowed: must be after 'from'");
          });
  return table;
}

/// Throws unless yield and hardening are given in one way each, and a goal is free to change volumes.
void check_ways(PlasticityConfig& config, const Value& map, const std::string& path) {
  if (config.yield_strain.has_value() == config.yield_stress.has_value())
    fail(map, path, "needs either 'yield_strain' [-] or 'yield_stress' [Pa]");
  if (config.hardening && config.hardening_modulus)
    fail(map, path, "may have 'hardening' [-] or 'hardening_modulus' [Pa], not both");
  const auto* isochoric = map.find("isochoric");
  if (config.goal && isochoric != nullptr && config.isochoric)
    fail(*isochoric, join(path, "isochoric"), "does not go with 'goal': the way to a shape changes volumes");
  if (config.goal) config.isochoric = false;
  for (const auto& [key, given] : {std::pair{"yield_stress", config.yield_stress.has_value()},
                                   std::pair{"hardening_modulus", config.hardening_modulus.has_value()}})
    if (given && !config.isochoric)
      fail(*map.find(key), join(path, key),
           std::string("is a stress of isochoric flow: without that, give '") +
               (std::string(key) == "yield_stress" ? "yield_strain" : "hardening") + "'");
}

/// Throws for what one material and its plasticity cannot be together.
void check_material(const MaterialConfig& material, Precision precision, const PlasticityConfig& plasticity,
                    const Value& map, const std::string& path) {
  if (has_fibres(material.model))
    fail(map, path, "goes with isotropic materials, which 'model: " + name_of(material.model) + "' is not");
  if (precision == Precision::mixed)
    fail(map, path, "does not go with 'precision: mixed': plastic strain adds up, and is kept in double");
  if ((plasticity.yield_stress || plasticity.hardening_modulus) && !(lame_of(material).mu > 0))
    fail(map, path,
         "needs 'yield_strain' and 'hardening', since the material has no stiffness to divide a stress by");
}

}  // namespace

const Table<PlasticityConfig>& plasticity_table() {
  static const auto table =
      Table<PlasticityConfig>("Permanent deformation: F = F_e F_p, of which F_e alone has stress.")
          .either("yield_strain", &PlasticityConfig::yield_strain, number("-", above(0)), "0.05",
                  "Flow begins where the norm of the elastic log strain exceeds this; with 'isochoric' that "
                  "of its "
                  "deviator.")
          .either("yield_stress", &PlasticityConfig::yield_stress, number("Pa", above(0)), "4e8",
                  "The same by the stress in tension, of small elastic strains: yield_strain = "
                  "yield_stress/(sqrt(6) "
                  "mu).")
          .either("hardening", &PlasticityConfig::hardening, number("-", at_least(0)), "0.1",
                  "What yield_strain grows by with the length of the way that log F_p has gone.")
          .either(
              "hardening_modulus", &PlasticityConfig::hardening_modulus, number("Pa", at_least(0)), "1e8",
              "The same by the slope of stress over plastic strain in tension: hardening = modulus/(3 mu).")
          .optional("isochoric", &PlasticityConfig::isochoric, yes_or_no(), "false",
                    "Flow keeps the volume, as of metals; false: it does not, as of snow and clay, and of "
                    "whatever has a "
                    "goal.")
          .optional("relaxation_time", &PlasticityConfig::relaxation_time, number("s", at_least(0)), "0.01",
                    "In which what exceeds the yield flows; 0: at once.")
          .optional("limit", &PlasticityConfig::limit, number("-", above(1)), "4",
                    "No direction becomes longer than this many times, or shorter than one of this many "
                    "parts, for good.")
          .optional("goal", &PlasticityConfig::goal, table_of(goal_table()), "{flatten: 0.3, strength: 1}",
                    "A shape that flow is led to; of bodies, not of groups.")
          .then(check_ways);
  return table;
}

void check_plasticity(BodyConfig& body, const Value& map, const std::string& path) {
  if (body.plasticity)
    check_material(body.material, body.precision, *body.plasticity, *map.find("plasticity"),
                   join(path, "plasticity"));
  for (const auto& group : body.groups) {
    const auto& plasticity = group.plasticity ? group.plasticity : body.plasticity;
    if (!plasticity) continue;
    const auto& of_group = *map.find("groups")->find(group.name);
    const auto* written = of_group.find("plasticity");
    const auto where = join(join(path, "groups"), group.name);
    if (group.plasticity && group.plasticity->goal)
      fail(*written->find("goal"), join(join(where, "plasticity"), "goal"),
           "is that of a body, not of a group");
    check_material(group.material.value_or(body.material), body.precision, *plasticity,
                   written != nullptr ? *written : of_group, where);
  }
}

}  // namespace evert
