#include "evert/core/error.hpp"
#include "evert/scene/material.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

/// The keys of a material, and which go with which.
namespace evert {

using namespace schema;

namespace {

using Models = std::vector<MaterialModel>;

const std::vector<Choice<MaterialModel>>& models() {
  using enum MaterialModel;
  static const std::vector<Choice<MaterialModel>> all{
      {"neo_hookean", neo_hookean, "stiffens under compression; large strains"},
      {"rotated_linear", rotated_linear, "linear in the stretches; fast, robust"},
      {"st_venant_kirchhoff", st_venant_kirchhoff, "linear in Green's strain; softens under compression"},
      {"mooney_rivlin", mooney_rivlin, "rubber and flesh: shape and volume apart"},
      {"spline", spline, "soft for small strains, stiff beyond given stretches"},
      {"stable_neo_hookean", stable_neo_hookean,
       "smooth through inversion; collapsed to a line it feels no force across"},
      {"muscle", muscle, "mooney_rivlin with fibres that contract: needs 'fibres' of the body"},
      {"tendon", tendon, "the same without activation: needs 'fibres' of the body"}};
  return all;
}

std::vector<std::string> names_of(const Models& some) {
  std::vector<std::string> names;
  for (const auto model : some) names.push_back(name_of(model));
  return names;
}

/// Throws when a key is given that belongs to other models.
void check_keys_of_model(const MaterialConfig& material, const Value& map, const std::string& path) {
  using enum MaterialModel;
  const Models with_extension{neo_hookean, st_venant_kirchhoff, mooney_rivlin};
  const Models with_limit{neo_hookean, st_venant_kirchhoff, mooney_rivlin, spline, muscle, tendon};
  const Models with_constants{mooney_rivlin, muscle, tendon};
  const Models with_fibres{muscle, tendon};
  const std::vector<std::pair<const char*, Models>> owned{
      {"compression_limit", with_limit},   {"extension", with_extension},
      {"mu_10", with_constants},           {"mu_01", with_constants},
      {"bulk_modulus", with_constants},    {"mu_01_share", with_constants},
      {"elongation_limit", {spline}},      {"compression_stiffening", {spline}},
      {"elongation_stiffening", {spline}}, {"peak_stress", with_fibres},
      {"passive_factor", with_fibres},     {"passive_exponent", with_fibres},
      {"passive_limit", with_fibres},      {"active_width", {muscle}},
  };
  for (const auto& [key, owners] : owned) {
    const auto* value = map.find(key);
    if (value != nullptr && std::ranges::find(owners, material.model) == owners.end())
      fail(*value, join(path, key),
           "does not go with 'model: " + name_of(material.model) + "', only with " +
               list_of(names_of(owners)));
  }
}

bool has_mooneys_constants(MaterialModel model) {
  return model == MaterialModel::mooney_rivlin || has_fibres(model);
}

/// Throws unless the moduli are given in exactly one way, and completely.
void check_moduli(const MaterialConfig& material, const Value& map, const std::string& path) {
  const auto given = [&](std::initializer_list<const char*> keys) {
    return std::ranges::count_if(keys, [&](const char* key) { return map.find(key) != nullptr; });
  };
  const auto engineering = given({"youngs_modulus", "poissons_ratio"});
  const auto lame = given({"lambda", "mu"});
  const auto constants = given({"mu_10", "mu_01", "bulk_modulus"});
  const bool one_way = (engineering == 2 && lame == 0 && constants == 0) ||
                       (engineering == 0 && lame == 2 && constants == 0) ||
                       (engineering == 0 && lame == 0 && constants == 3);
  if (one_way) return;
  std::string ways = "needs either 'youngs_modulus' [Pa] and 'poissons_ratio' [-], or 'lambda' and 'mu' [Pa]";
  if (has_mooneys_constants(material.model)) ways += ", or 'mu_10', 'mu_01' and 'bulk_modulus' [Pa]";
  fail(map, path, ways);
}

/// Throws where the passive curve of fibres grows beyond all sense before it becomes linear.
void check_passive_curve(const MaterialConfig& material, const Value& map, const std::string& path) {
  constexpr double most = 50;  // e^50: twenty orders of magnitude above any tissue
  const PassiveCurve curve;
  const double grown = material.passive_exponent.value_or(curve.exponent) *
                       (material.passive_limit.value_or(curve.linear_from) - 1);
  if (grown <= most) return;
  const auto* key = material.passive_exponent ? "passive_exponent" : "passive_limit";
  const auto& value = *map.find(key);
  fail(value, join(path, key),
       shown(value) + " is not allowed: passive_exponent (passive_limit - 1) must be at most 50");
}

/// Throws for what depends on several numbers.
void check_numbers(const MaterialConfig& material, const Value& map, const std::string& path) {
  const auto wrong = [&](const char* key, const std::string& why) {
    const auto& value = *map.find(key);
    fail(value, join(path, key), shown(value) + " is not allowed: " + why);
  };
  if (material.lambda && !(*material.lambda > -2.0 / 3 * *material.mu))
    wrong("lambda", "must be > -2/3 mu, or compression meets no resistance");
  if (material.mu_10 && *material.mu_10 + *material.mu_01 == 0)
    wrong("mu_10", "mu_10 and mu_01 must not both be 0");
  const auto expect_matrix = [&](const char* key, const std::optional<double>& value) {
    if (has_fibres(material.model) && value && !(*value > 0))
      wrong(key, "must be > 0 with 'model: " + name_of(material.model) + "': fibres need a matrix");
  };
  expect_matrix("youngs_modulus", material.youngs_modulus);
  expect_matrix("mu", material.mu);
  if (material.mu_10 && map.find("mu_01_share") != nullptr) wrong("mu_01_share", "mu_01 says it already");
  const bool at_end =
      material.compression_limit && (*material.compression_limit == 0 || *material.compression_limit == 1);
  if (at_end && material.model != MaterialModel::spline)
    wrong("compression_limit", "must be in (0, 1) with 'model: " + name_of(material.model) + "'");
}

void add_moduli(Table<MaterialConfig>& table) {
  table
      .either("youngs_modulus", &MaterialConfig::youngs_modulus, number("Pa", at_least(0)), "1e5",
              "Stiffness, with poissons_ratio. 0 is a body without elastic forces.")
      .either("poissons_ratio", &MaterialConfig::poissons_ratio, number("-", between(-1, 0.5)), "0.45",
              "Lateral contraction over extension; towards 0.5 the volume is kept.")
      .either("lambda", &MaterialConfig::lambda, number("Pa"), "1e5",
              "First Lame parameter, with mu, instead of youngs_modulus and poissons_ratio; > -2/3 mu.")
      .either("mu", &MaterialConfig::mu, number("Pa", at_least(0)), "5e4",
              "Shear modulus of small strains. 0 is a body that resists changes of volume only.")
      .either(
          "mu_10", &MaterialConfig::mu_10, number("Pa", at_least(0)), "6e4",
          "Of mooney_rivlin, muscle and tendon, with mu_01 and bulk_modulus instead of youngs_modulus and "
          "poissons_ratio: the factor of the first invariant. The shear modulus of small strains is 2 (mu_10 "
          "+ mu_01).")
      .either("mu_01", &MaterialConfig::mu_01, number("Pa", at_least(0)), "2e4",
              "With mu_10: the factor of the second invariant.")
      .either("bulk_modulus", &MaterialConfig::bulk_modulus, number("Pa", above(0)), "1e6",
              "With mu_10: resistance to changes of volume.")
      .optional("mu_01_share", &MaterialConfig::mu_01_share, number("-", from_to(0, 1)), "0.25",
                "Of mooney_rivlin, muscle and tendon given by youngs_modulus or mu: mu_01 / (mu_10 + mu_01); "
                "without it 0.25.");
}

void add_limits(Table<MaterialConfig>& table) {
  table
      .optional("compression_limit", &MaterialConfig::compression_limit, number("-", from_to(0, 1)), "0.3",
                "Principal stretch below which the model is extended through flat and inverted states, in "
                "(0, 1); without it 0.3 for neo_hookean, 0.58 for st_venant_kirchhoff, 0.35 for "
                "mooney_rivlin, 0.25 for muscle and tendon. Of spline: where compression becomes stiff, in "
                "[0, 1], 0.5 without it.")
      .optional("extension", &MaterialConfig::extension,
                one_of<Extension>(
                    {{"linear", Extension::linear, "the energy is continued: exact gradient, uninverts"},
                     {"clamp", Extension::clamp, "stress at the limit: for comparison"}}),
                "linear", "How the model continues below compression_limit.")
      .optional("elongation_limit", &MaterialConfig::elongation_limit, number("-", at_least(1)), "1.5",
                "Of spline: principal stretch above which elongation is stiff; 1.5 without it.")
      .optional("compression_stiffening", &MaterialConfig::compression_stiffening, number("-", above(0)),
                "10",
                "Of spline: slope of the stress below compression_limit over that at rest; 10 without it.")
      .optional("elongation_stiffening", &MaterialConfig::elongation_stiffening, number("-", above(0)), "10",
                "Of spline: slope of the stress above elongation_limit over that at rest; 10 without it.");
}

void add_fibres(Table<MaterialConfig>& table) {
  table
      .optional("peak_stress", &MaterialConfig::peak_stress, number("Pa", at_least(0)), "3e5",
                "Of muscle and tendon: tension of the fibres, per area at rest, that their curves are "
                "multiplied with: that of muscle at rest length with activation 1; 3e5 without it.")
      .optional(
          "passive_factor", &MaterialConfig::passive_factor, number("-", at_least(0)), "0.05",
          "Of muscle and tendon: factor f of the passive curve f (exp(e s) - e s - 1), s = stretch of the "
          "fibre - 1 > 0; 0.05 without it.")
      .optional("passive_exponent", &MaterialConfig::passive_exponent, number("-", above(0)), "6.6",
                "Of muscle and tendon: the exponent e; 6.6 without it.")
      .optional("passive_limit", &MaterialConfig::passive_limit, number("-", at_least(1)), "1.4",
                "Of muscle and tendon: stretch of the fibre above which the passive curve is linear; 1.4 "
                "without it.")
      .optional("active_width", &MaterialConfig::active_width, number("-", between(0, 1)), "0.6",
                "Of muscle: w of the active curve 1 - (s / w)^2, zero beyond; 0.6 without it.");
}

}  // namespace

std::string name_of(MaterialModel model) {
  return std::ranges::find(models(), model, &Choice<MaterialModel>::value)->word;
}

const Table<MaterialConfig>& material_table() {
  static const auto table = [] {
    Table<MaterialConfig> keys(
        "An elastic model, and its moduli: either youngs_modulus and poissons_ratio, or lambda and mu.");
    keys.required("model", &MaterialConfig::model, one_of(models()), "neo_hookean",
                  "How stress follows from strain; docs/materials.md compares them.");
    add_moduli(keys);
    add_limits(keys);
    add_fibres(keys);
    keys.then(check_keys_of_model).then(check_moduli).then(check_numbers).then(check_passive_curve);
    return keys;
  }();
  return table;
}

}  // namespace evert
