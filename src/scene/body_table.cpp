#include "tables.hpp"

/// Bodies: mesh, placement, material, damping, start.
namespace evert {

using namespace schema;

const Table<RotationConfig>& rotation_table() {
  static const auto table =
      Table<RotationConfig>("A rotation about an axis through the origin, by the right-hand rule.")
          .required("axis", &RotationConfig::axis, direction(), "[1, 0, 0]", "Direction of the axis.")
          .required("angle", &RotationConfig::angle, number("degrees"), "90", "Angle of the rotation.");
  return table;
}

namespace {

const Table<TransformConfig>& transform_table() {
  static const auto table =
      Table<TransformConfig>(
          "Makes the rest shape from the mesh and places it: fit, then scale, then rotate, then translate.")
          .optional("fit", &TransformConfig::fit, number("m", above(0)), "1",
                    "First centre the bounding box at the origin and make its longest side this long.")
          .optional("scale", &TransformConfig::scale, number("-", above(0)), "0.001",
                    "Then scale about the origin, e.g. a mesh in millimetres by 0.001.")
          .optional("rotate", &TransformConfig::rotate, table_of(rotation_table()),
                    "{axis: [1, 0, 0], angle: 90}", "Then rotate about the origin.")
          .optional("translate", &TransformConfig::translate, vector3("m"), "[0, 1, 0]", "Then translate.");
  return table;
}

const Table<StartConfig>& start_table() {
  static const auto table =
      Table<StartConfig>(
          "Where the nodes start instead of at rest: (1 - amplitude) of their place at rest plus "
          "amplitude of a target.")
          .required("kind", &StartConfig::kind,
                    one_of<StartKind>(
                        {{"none", StartKind::none, "at rest, as without 'start'"},
                         {"scramble", StartKind::scramble, "target: a random point of the bounding box"},
                         {"flatten_plane", StartKind::flatten_plane,
                          "target: the plane through the centre, normal to axis"},
                         {"flatten_line", StartKind::flatten_line,
                          "target: the line through the centre along axis"},
                         {"flatten_point", StartKind::flatten_point, "target: the centre"},
                         {"inside_out", StartKind::inside_out,
                          "target: the mirror image at the plane normal to axis"}}),
                    "scramble", "The target.")
          .optional("amplitude", &StartConfig::amplitude, number("-", above(0)), "0.5",
                    "How far towards the target; above 1 beyond it.")
          .optional("axis", &StartConfig::axis, direction(), "[0, 1, 0]",
                    "Normal of the plane or direction of the line.")
          .optional("seed", &StartConfig::seed, seed_number(), "7", "Of the random points of scramble.");
  return table;
}

void check_damping(const DampingConfig& damping, const Value& map, const std::string& path) {
  const auto has = [&](const char* key) { return map.find(key) != nullptr ? 1 : 0; };
  const int ways = has("stiffness_proportional") + has("stiffness_ratio") + (has("alpha") | has("beta"));
  if (damping.model != DampingModel::none && ways != 1)
    fail(
        map, path,
        "needs one of 'stiffness_proportional' [s], 'stiffness_ratio' at a 'frequency' [Hz], and 'alpha' and "
        "'beta' [Pa s]");
  if (has("mass_proportional") + has("mass_ratio") > 1)
    fail(map, path, "may have 'mass_proportional' [1/s] or 'mass_ratio', not both");
  const int ratios = has("stiffness_ratio") + has("mass_ratio");
  if (ratios > 0 && has("frequency") == 0)
    fail(map, path, "needs the 'frequency' [Hz] that its damping ratio is meant at");
  if (ratios == 0 && has("frequency") != 0)
    fail(*map.find("frequency"), join(path, "frequency"),
         "goes with 'stiffness_ratio' or 'mass_ratio', and none is there");
}

bool damps_nothing(const DampingConfig& damping) {
  return damping.model == DampingModel::none && !damping.mass_proportional && !damping.mass_ratio;
}

/// What the scene switches off by "none" is not there. (A group keeps it: it differs from a damped body.)
void drop_what_is_none(BodyConfig& body, const Value& /*map*/, const std::string& /*path*/) {
  if (body.damping && damps_nothing(*body.damping)) body.damping.reset();
  if (body.start && body.start->kind == StartKind::none) body.start.reset();
}

/// Throws where a model has no dilatation whose mean could be taken.
void check_dilatation(BodyConfig& body, const Value& map, const std::string& path) {
  if (!body.mean_dilatation) return;
  const auto check = [&](const MaterialConfig& material) {
    if (material.model != MaterialModel::neo_hookean && material.model != MaterialModel::rotated_linear)
      fail(*map.find("mean_dilatation"), join(path, "mean_dilatation"),
           "goes with 'model: neo_hookean' and 'rotated_linear', not with '" + name_of(material.model) + "'");
  };
  check(body.material);
  for (const auto& group : body.groups)
    if (group.material) check(*group.material);
}

const Table<GroupConfig>& group_table() {
  static const auto table =
      Table<GroupConfig>("A named volume group of the mesh; what it does not say is as in the body.")
          .optional("density", &GroupConfig::density, number("kg/m^3", above(0)), "1200", "Mass per volume.")
          .optional("material", &GroupConfig::material, table_of(material_table()),
                    "{model: neo_hookean, youngs_modulus: 1e6, poissons_ratio: 0.4}", "Elastic model.")
          .optional("damping", &GroupConfig::damping, table_of(damping_table()),
                    "{model: rotated, stiffness_proportional: 0.01}",
                    "Damping; {model: none} for a group without.")
          .optional("activation", &GroupConfig::activation, activation_type(), "[[0, 0], [0.5, 1]]",
                    "Of its muscle.")
          .optional("plasticity", &GroupConfig::plasticity, table_of(plasticity_table()),
                    "{yield_strain: 0.1}", "Permanent deformation.");
  return table;
}

}  // namespace

const Table<DampingConfig>& damping_table() {
  static const auto table =
      Table<DampingConfig>(
          "Viscous damping, taken implicitly: of the rate of strain, and of velocity where a mass key is "
          "given.")
          .required("model", &DampingConfig::model,
                    one_of<DampingModel>(
                        {{"rotated", DampingModel::rotated, "robust when flat"},
                         {"objective", DampingModel::objective, "keeps angular momentum; vanishes when flat"},
                         {"blended", DampingModel::blended,
                          "objective where no stretch is below 0.5, rotated where one is below 0.1, smooth "
                          "between"},
                         {"none", DampingModel::none, "not at all"}}),
                    "rotated", "How the damping stress follows from the rate of strain.")
          .either("stiffness_proportional", &DampingConfig::stiffness_proportional, number("s", at_least(0)),
                  "0.01", "Time R: alpha = R lambda and beta = R mu, with the Lame parameters of the moment.")
          .either("stiffness_ratio", &DampingConfig::stiffness_ratio, number("-", at_least(0)), "0.05",
                  "The same by the share of critical damping that a vibration of 'frequency' f gets: R = "
                  "ratio/(pi f).")
          .either("alpha", &DampingConfig::alpha, number("Pa s", at_least(0)), "100",
                  "Volumetric coefficient.")
          .either("beta", &DampingConfig::beta, number("Pa s", at_least(0)), "50", "Shear coefficient.")
          .either("mass_proportional", &DampingConfig::mass_proportional, number("1/s", at_least(0)), "0.5",
                  "Besides, a force -a m v on every node, also in free flight.")
          .either(
              "mass_ratio", &DampingConfig::mass_ratio, number("-", at_least(0)), "0.02",
              "The same by the share of critical damping that a vibration of 'frequency' f gets: a = 4 pi f "
              "ratio.")
          .either("frequency", &DampingConfig::frequency, number("Hz", above(0)), "2",
                  "Of the vibration that the ratios are meant for.")
          .then(check_damping);
  return table;
}

const Table<BodyConfig>& body_table() {
  static const auto table =
      Table<BodyConfig>("A deformable body.")
          .required("mesh", &BodyConfig::mesh, table_of(mesh_table()),
                    "{generate: ball, radius: 0.5, edge_length: 0.1}", "Its rest shape.")
          .optional("order", &BodyConfig::order, integer(1, 2), "2",
                    "Of the shape functions. 2 puts a node in the middle of every edge of a mesh of "
                    "tetrahedra.")
          .optional("transform", &BodyConfig::transform, table_of(transform_table()),
                    "{translate: [0, 1, 0]}", "Size and place of the rest shape.")
          .required("density", &BodyConfig::density, number("kg/m^3", above(0)), "1000",
                    "Mass per volume at rest.")
          .optional("velocity", &BodyConfig::velocity, vector3("m/s"), "[0, -2, 0]", "At the start.")
          .optional("spin", &BodyConfig::spin, vector3("rad/s"), "[0.5, 0.25, 0]",
                    "Angular velocity at the start, about the centre of mass.")
          .optional("start", &BodyConfig::start, table_of(start_table()), "{kind: flatten_plane}",
                    "Start away from the rest shape.")
          .required("material", &BodyConfig::material, table_of(material_table()),
                    "{model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.45}", "Elastic model.")
          .optional("damping", &BodyConfig::damping, table_of(damping_table()),
                    "{model: rotated, stiffness_proportional: 0.001}", "Without it the body is not damped.")
          .optional("fibres", &BodyConfig::fibres, table_of(fibre_table()), "{direction: [1, 0, 0]}",
                    "Where the fibres of muscle and tendon run at rest; needed there, and there only.")
          .optional(
              "activation", &BodyConfig::activation, activation_type(), "[[0, 0], [0.5, 1]]",
              "Of muscle: a constant from 0 to 1, or a table of times and values, linear in between and "
              "constant outside. Without it muscle is not active.")
          .optional("plasticity", &BodyConfig::plasticity, table_of(plasticity_table()),
                    "{yield_strain: 0.05}", "Permanent deformation; without it the body is elastic.")
          .optional("mean_dilatation", &BodyConfig::mean_dilatation, yes_or_no(), "true",
                    "Of elements with several points (all but tet4) of neo_hookean and rotated_linear: "
                    "changes of volume "
                    "are resisted by their mean over the element, which then does not lock where the volume "
                    "is nearly "
                    "kept, as in isochoric flow.")
          .optional("precision", &BodyConfig::precision,
                    one_of<Precision>({{"double", Precision::full, "everything in double"},
                                       {"mixed", Precision::mixed,
                                        "elements in float, nodes in double: less memory, faster but for the "
                                        "damping of tetrahedra; unfit for small strains "
                                        "(docs/performance.md)"}}),
                    "double", "Of the forces of its elements.")
          .optional("groups", &BodyConfig::groups, named(group_table()), "{tendon: {density: 1200}}",
                    "Volume groups of the mesh that differ from the body, by name.")
          .then(drop_what_is_none)
          .then(check_fibres)
          .then(check_plasticity)
          .then(check_dilatation);
  return table;
}

}  // namespace evert
