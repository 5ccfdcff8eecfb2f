#include "evert/app/material_command.hpp"

#include "evert/app/command_line.hpp"
#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/io/files.hpp"
#include "evert/scene/material.hpp"

#include "command_options.hpp"
#include "material_gradients.hpp"
#include "material_paths.hpp"
#include "material_plot.hpp"
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

namespace evert {
namespace {

constexpr const char* help =
    R"(evert material: drives a material at one point, through flat and into the inverted

evert material MODEL [options]           print stress and energy along paths of deformation
evert material MODEL -plot OUT.svg       draw them; with MODEL 'all' every model
evert material MODEL -gradients F.txt [-o P.csv]
                                         stress of each deformation gradient of a file: 9 numbers a line, row
                                         by row; to compare with another code
  -path P                                uniaxial, biaxial, volumetric, shear, of models with fibres
                                         across, or all; all unless given
  -from S, -to S                         range of the stretch; -1 to 2 unless given
  -points N                              rows of a table; 13 unless given

Models: )";

constexpr const char* more_help = R"(
Options of the material, as the keys of a scene (evert explain bodies.material):
  -youngs_modulus E, -poissons_ratio NU  1 Pa and 0.3 unless given, so that stress is in units of E
  -lambda L -mu M                        instead of these; the constants of paper A for muscle and tendon,
                                         6e4, 2e4 and 6e4 Pa, unless given
  -fibre X,Y,Z                           of models with fibres: their direction; 1,0,0 unless given
  -activation A                          of muscle, from 0 to 1; 0 unless given
)";

constexpr const char* examples = R"(
P is the first Piola-Kirchhoff stress [Pa] of F = U diag(sigma) V^T, row by row in CSV.

Examples:
  evert material neo_hookean -path uniaxial
  evert material muscle -activation 1 -bulk_modulus 6e5 -mu_10 6e4 -mu_01 2e4 -plot muscle.svg
  evert material all -plot models.svg
  evert material st_venant_kirchhoff -youngs_modulus 1e5 -poissons_ratio 0.45 -gradients f.txt -o p.csv
)";

/// The keys that a scene gives a material, but for the model.
std::vector<std::string> material_keys() {
  std::vector<std::string> keys;
  for (const auto& key : material_table().info().keys)
    if (key.name != "model") keys.push_back(key.name);
  return keys;
}

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const auto& choice : material_table().info().find("model")->type.choices) names.push_back(choice.word);
  return names;
}

std::string usage_of_material() {
  std::string text = help + list_of(model_names()) + "." + more_help;
  for (const auto& key : material_table().info().keys) {
    const std::array said{"model", "youngs_modulus", "poissons_ratio", "lambda", "mu"};
    if (std::ranges::find(said, key.name) != said.end()) continue;
    text += "  -" + key.name + " (" + key.example + ")\n";
  }
  return text + examples;
}

/// Of a name that may be no model at all.
bool has_fibres(const std::string& model) {
  return model == name_of(MaterialModel::muscle) || model == name_of(MaterialModel::tendon);
}

/// The material that the options describe, read and checked as that of a scene.
MaterialConfig material_from(const CommandOptions& options, const std::string& model) {
  using schema::Value;
  const auto scalar = [](const std::string& text) {
    return Value{.kind = Value::Kind::scalar, .where = "evert material", .text = text};
  };
  Value map{.kind = Value::Kind::map, .where = "evert material"};
  map.set("model", scalar(model));
  for (const auto& key : material_keys())
    if (options.has(key)) map.set(key, scalar(options.text(key)));
  const auto any_of = [&](std::initializer_list<const char*> keys) {
    return std::ranges::any_of(keys, [&](const char* key) { return map.find(key) != nullptr; });
  };
  const auto set_if_missing = [&](const char* key, const char* value) {
    if (map.find(key) == nullptr) map.set(key, scalar(value));
  };
  const bool otherwise = any_of({"lambda", "mu", "mu_10", "mu_01", "bulk_modulus"});
  if (has_fibres(model) && !otherwise && !any_of({"youngs_modulus", "poissons_ratio"})) {
    set_if_missing("mu_10", "6e4");
    set_if_missing("mu_01", "2e4");
    set_if_missing("bulk_modulus", "6e4");
  } else if (!otherwise) {
    set_if_missing("youngs_modulus", "1");
    set_if_missing("poissons_ratio", "0.3");
  }
  return material_table().read(map, "");
}

/// The same as it answers at a point. Options of fibres are checked already.
PointMaterial point_from(const CommandOptions& options, const MaterialConfig& config) {
  PointMaterial point{material_of(config)};
  if (options.has("activation")) set_activation(point.material, options.number("activation"));
  if (options.has("fibre")) {
    const auto fibre = options.three_numbers("fibre");
    point.fibre = (1 / norm(fibre)) * fibre;
  }
  return point;
}

struct Range {
  double from = -1, to = 2;
};

Range range_from(const CommandOptions& options) {
  Range range;
  if (options.has("from")) range.from = options.number("from");
  if (options.has("to")) range.to = options.number("to");
  const double resolved = 1e-9 * std::max(std::abs(range.from), std::abs(range.to));
  if (!(range.to - range.from > resolved))
    throw UserError("evert material: -from must be less than -to: from " + formatted("%g", range.from) +
                    " to " + formatted("%g", range.to));
  return range;
}

std::vector<PathInfo> paths_from(const CommandOptions& options, const Material& material) {
  const auto all = paths_of(material);
  if (!options.has("path") || options.text("path") == "all") return {all.begin(), all.end()};
  const auto wanted = options.text("path");
  std::vector<std::string> names;
  for (const auto& info : all) {
    if (info.name == wanted) return {info};
    names.push_back(info.name);
  }
  names.emplace_back("all");
  throw UserError("evert material: -path is '" + wanted + "': must be " + list_of(names) +
                  did_you_mean(wanted, names));
}

std::string title_of(const MaterialConfig& config) {
  const Lame lame = lame_of(config);
  return name_of(config.model) + formatted(", lambda %g Pa, mu %g Pa", lame.lambda, lame.mu);
}

void print_path(const PointMaterial& at, const PathInfo& info, const Range& range, int points,
                std::ostream& out) {
  out << '\n' << info.name << ": " << info.deformation << '\n';
  out << formatted("%12s %15s %15s %15s %15s %15s\n", "s", "P_xx [Pa]", "P_xy [Pa]", "P_yy [Pa]", "P_zz [Pa]",
                   "energy [J/m^3]");
  for (int i = 0; i < points; ++i) {
    const double s = range.from + (range.to - range.from) * i / (points - 1);
    const auto [stretches, p, energy] = response_on_path(at, info.path, s);
    out << formatted("%12.6g %15.7g %15.7g %15.7g %15.7g %15.7g\n", s, p(0, 0), p(0, 1), p(1, 1), p(2, 2),
                     energy);
  }
}

int table_command(const CommandOptions& options, std::ostream& out) {
  const auto config = material_from(options, options.file(0));
  const auto point = point_from(options, config);
  const auto range = range_from(options);
  const auto paths = paths_from(options, point.material);
  const int points = options.has("points") ? options.whole_number("points") : 13;
  constexpr int most = 1'000'000;
  if (points < 2 || points > most)
    throw UserError("evert material: -points must be from 2 to 1000000, not " + options.text("points"));
  out << title_of(config) << '\n';
  for (const auto& info : paths) print_path(point, info, range, points, out);
  return 0;
}

int plot_command(const CommandOptions& options, std::ostream& out) {
  const auto range = range_from(options);
  const auto& model = options.file(0);
  std::vector<PlottedMaterial> plotted;
  for (const auto& name : model == "all" ? model_names() : std::vector{model})
    plotted.push_back({name, point_from(options, material_from(options, name))});
  const auto path = options.text("plot");
  write_file(path, stress_plot(plotted, range.from, range.to));
  out << "wrote " << path << '\n';
  return 0;
}

/// So many digits that reading gives the same number.
std::string row_of(const PointResponse& response) {
  std::string row;
  const auto append = [&](double value) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    row += (row.empty() ? "" : ",") + std::string(text.data(), end);
  };
  for (const double stretch : response.stretches.components) append(stretch);
  for (std::size_t i = 0; i < 9; ++i) append(response.stress(i / 3, i % 3));
  append(response.energy);
  return row + '\n';
}

int gradients_command(const CommandOptions& options, std::ostream& out) {
  const auto point = point_from(options, material_from(options, options.file(0)));
  const auto gradients = read_deformation_gradients(options.text("gradients"));
  std::string csv =
      "sigma_1,sigma_2,sigma_3,P_11 [Pa],P_12 [Pa],P_13 [Pa],P_21 [Pa],P_22 [Pa],P_23 [Pa],P_31 [Pa],"
      "P_32 [Pa],P_33 [Pa],energy [J/m^3]\n";
  for (const Mat3d& f : gradients) csv += row_of(response_to(point, f));
  if (!options.has("o")) {
    out << csv;
    return 0;
  }
  write_file(options.text("o"), csv);
  out << "wrote " << options.text("o") << ": " << gradients.size() << " stresses\n";
  return 0;
}

/// Throws unless they are there only where there are fibres, and make sense.
void check_fibre_options(const CommandOptions& options) {
  const auto& model = options.file(0);
  if (options.has("fibre") && !has_fibres(model))
    throw UserError("evert material: -fibre goes with muscle and tendon only");
  if (options.has("activation") && model != name_of(MaterialModel::muscle))
    throw UserError("evert material: -activation goes with muscle only");
  const double length = options.has("fibre") ? norm(options.three_numbers("fibre")) : 1;
  if (!(length > 0 && std::isfinite(length)))
    throw UserError(
        "evert material: -fibre must not be 0,0,0, nor beyond what can be squared: it is a direction");
  if (options.has("activation") && !(options.number("activation") >= 0 && options.number("activation") <= 1))
    throw UserError("evert material: -activation must be in [0, 1], not " + options.text("activation"));
}

/// Throws unless the options go with what is asked for.
void check_options(const CommandOptions& options) {
  const auto only = [&](const char* option, const char* with) {
    if (options.has(option) && !options.has(with))
      throw UserError(std::string("evert material: -") + option + " goes with -" + with + " only");
  };
  const auto exclude = [&](const char* a, const char* b) {
    if (options.has(a) && options.has(b))
      throw UserError(std::string("evert material: -") + a + " and -" + b + " exclude each other");
  };
  only("o", "gradients");
  exclude("plot", "gradients");
  for (const auto* option : {"path", "points"})
    for (const auto* other : {"plot", "gradients"}) exclude(option, other);
  for (const auto* option : {"from", "to"}) exclude(option, "gradients");
  if (options.file(0) == "all" && !options.has("plot"))
    throw UserError("evert material: the model 'all' goes with -plot only");
  check_fibre_options(options);
}

}  // namespace

int material_command(std::span<const std::string> arguments, std::ostream& out) {
  if (asks_for_help(arguments)) {
    out << usage_of_material();
    return 0;
  }
  auto known = std::vector<std::string>{"path",      "from", "to",    "points",    "plot",
                                        "gradients", "o",    "fibre", "activation"};
  for (const auto& key : material_keys()) known.push_back(key);
  const CommandOptions options("evert material", arguments, known, {},
                               {"a model: " + list_of(model_names()) + ", or all"});
  check_options(options);
  if (options.has("gradients")) return gradients_command(options, out);
  if (options.has("plot")) return plot_command(options, out);
  return table_command(options, out);
}

}  // namespace evert
