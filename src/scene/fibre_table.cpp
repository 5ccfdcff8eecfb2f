#include "tables.hpp"
#include <cmath>
#include <functional>

/// Where fibres run, and how active they are.
namespace evert {

using namespace schema;

namespace {

const Table<ConstantFibres>& constant_fibres() {
  static const auto table = Table<ConstantFibres>("The same everywhere.")
                                .required("direction", &ConstantFibres::direction, direction(), "[1, 0, 0]",
                                          "Of all fibres at rest, in the world after the body's transform.");
  return table;
}

const Table<FieldFibres>& field_fibres() {
  static const auto table =
      Table<FieldFibres>("From the mesh file.")
          .required(
              "field", &FieldFibres::field, text("name"), "fibres",
              "A cell field of vectors of the mesh file: $ElementData with 3 components of Gmsh, a cell "
              "array with 3 components of VTK. It turns with the body's transform. Any length but 0.");
  return table;
}

const Table<CurveFibres>& curve_fibres() {
  static const auto table =
      Table<CurveFibres>("Along a curve.")
          .required("curve", &CurveFibres::curve, sequence_of(vector3("m")), "[[0, 0, 0], [0.5, 0.1, 0]]",
                    "Points of a polyline, in the world after the body's transform: each cell takes the "
                    "direction of the segment that is nearest to its centre.")
          .then([](CurveFibres& fibres, const Value& map, const std::string& path) {
            const auto& list = *map.find("curve");
            if (fibres.curve.size() < 2) fail(list, join(path, "curve"), "must have two points at least");
            for (std::size_t i = 1; i < fibres.curve.size(); ++i) {
              const Vec3d segment = fibres.curve[i] - fibres.curve[i - 1];
              const auto where = join(path, "curve") + "[" + std::to_string(i) + "]";
              if (!std::isfinite(dot(segment, segment)))
                fail(list.items[i], where, "is too far from the point before it");
              if (!(dot(segment, segment) > 0))
                fail(list.items[i], where, "is the point before it once more: a segment needs a direction");
            }
          });
  return table;
}

const MaterialConfig& material_of_group(const BodyConfig& body, const GroupConfig& group) {
  return group.material ? *group.material : body.material;
}

/// Throws when activation is given where nothing can become active.
void check_activation(const BodyConfig& body, const Value& map, const std::string& path) {
  const auto expect_muscle = [](bool muscle, const Value& value, const std::string& where) {
    if (!muscle) fail(value, where, "goes with 'model: muscle' only, of which there is none here");
  };
  bool any = body.material.model == MaterialModel::muscle;
  for (std::size_t g = 0; g < body.groups.size(); ++g) {
    const auto& group = body.groups[g];
    const bool muscle = material_of_group(body, group).model == MaterialModel::muscle;
    any = any || muscle;
    if (group.activation)
      expect_muscle(muscle, *map.find("groups")->find(group.name)->find("activation"),
                    join(join(join(path, "groups"), group.name), "activation"));
  }
  if (body.activation) expect_muscle(any, *map.find("activation"), join(path, "activation"));
}

}  // namespace

const Table<FibreConfig>& fibre_table() {
  static const auto table = Table<FibreConfig>("Directions of the fibres of muscle and tendon.")
                                .alternative_by_key("direction", std::identity{}, constant_fibres())
                                .alternative_by_key("field", std::identity{}, field_fibres())
                                .alternative_by_key("curve", std::identity{}, curve_fibres());
  return table;
}

Type<ActivationConfig> activation_type() {
  const auto level = number("-", from_to(0, 1));
  const auto time = number("s");
  return {.info = {.name = "number, or list of: [time, number]", .unit = "s, -", .range = "in [0, 1]"},
          .read =
              [=](const Value& value, const std::string& path) {
                if (value.kind != Value::Kind::list) return ActivationConfig{{0, level.read(value, path)}};
                ActivationConfig keys;
                for (const auto& row : value.items) {
                  const auto where = path + "[" + std::to_string(keys.size()) + "]";
                  expect_list(row, where, 2, "2 numbers, [time, activation]");
                  const ActivationKey key{time.read(row.items[0], where + "[0]"),
                                          level.read(row.items[1], where + "[1]")};
                  if (!keys.empty() && !(key.time > keys.back().time))
                    fail(row, where, "has a time that is not later than that of the row before");
                  keys.push_back(key);
                }
                if (keys.empty()) fail(value, path, "must not be an empty list: leave it out for none");
                return keys;
              },
          .write = [](const ActivationConfig&) { return std::string(); }};
}

void check_fibres(BodyConfig& body, const Value& map, const std::string& path) {
  bool needed = has_fibres(body.material.model);
  for (const auto& group : body.groups) needed = needed || has_fibres(material_of_group(body, group).model);
  if (needed && !body.fibres)
    fail(map, path, "needs 'fibres', a direction, field or curve: muscle and tendon have fibres");
  if (!needed && body.fibres)
    fail(*map.find("fibres"), join(path, "fibres"), "goes with the models muscle and tendon only");
  if (body.fibres && std::holds_alternative<FieldFibres>(*body.fibres) &&
      !std::holds_alternative<FileMesh>(body.mesh))
    fail(*map.find("fibres"), join(path, "fibres.field"),
         "goes with a mesh file only: a generated mesh has no fields");
  check_activation(body, map, path);
}

}  // namespace evert
