#include <gtest/gtest.h>

#include "case.hpp"
#include <fstream>
#include <sstream>

/// Cases of `evert material`.
namespace evert::cli {
namespace {

namespace fs = std::filesystem;

/// `evert material`, which needs one rank only.
Case good_material(const std::string& name, const std::string& arguments,
                   const std::vector<std::string>& says, const std::vector<File>& files = {},
                   const std::function<void(const fs::path& place)>& inspect = {}) {
  return {.name = name,
          .command = "material " + arguments,
          .files = files,
          .exit_code = 0,
          .says = says,
          .ranks = {1},
          .inspect = inspect};
}

Case bad_material(const std::string& name, const std::string& arguments, const std::vector<std::string>& says,
                  const std::vector<File>& files = {}) {
  return {.name = name, .command = "material " + arguments, .files = files, .says = says, .ranks = {1}};
}

const File gradients{"f.txt",
                     "# at rest, stretched and turned by 90 degrees, inverted\n"
                     "1 0 0 0 1 0 0 0 1\n\n0,-1,0,2,0,0,0,0,1  # commas\n+1 0 0 0 1 0 0 0 -1\n"};

/// λ = 4, μ = 6 of rotated_linear: P = R (2μ (S − 1) + λ tr(S − 1)).
void expect_stresses(const fs::path& place) {
  std::ifstream file(place / "p.csv");
  std::vector<std::string> rows;
  for (std::string row; std::getline(file, row);) rows.push_back(row);
  ASSERT_EQ(rows.size(), 4);
  EXPECT_TRUE(rows[0].starts_with("sigma_1,sigma_2,sigma_3,P_11 [Pa],P_12 [Pa]"));
  const std::vector<std::vector<double>> expected{{1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                                                  {2, 1, 1, 0, -4, 0, 16, 0, 0, 0, 0, 4, 8},
                                                  {1, 1, -1, -8, 0, 0, 0, -8, 0, 0, 0, -32, 32}};
  for (std::size_t i = 0; i < 3; ++i) {
    std::istringstream numbers(rows[i + 1]);
    std::string number;
    for (const double value : expected[i]) {
      ASSERT_TRUE(std::getline(numbers, number, ','));
      EXPECT_NEAR(std::stod(number), value, 1e-13) << rows[i + 1];
    }
  }
}

void expect_plot(const fs::path& place) {
  std::ostringstream content;
  content << std::ifstream(place / "all.svg").rdbuf();
  const std::string text = content.str();
  EXPECT_TRUE(text.starts_with("<svg") && text.ends_with("</svg>\n"));
  EXPECT_NE(text.find("stable_neo_hookean"), std::string::npos);
  EXPECT_EQ(text.find(",nan"), std::string::npos);
}

const std::vector<Case> cases{
    good_material("material_help", "--help", {"-gradients", "-mu_01_share", "mooney_rivlin"}),
    good_material("material_table", "rotated_linear -lambda 4 -mu 6 -path uniaxial -from -1 -to 1 -points 3",
                  {"lambda 4 Pa, mu 6 Pa", "uniaxial: principal stretches (s, 1, 1)",
                   "-1             -32               0              -8"}),
    good_material("material_all_paths", "mooney_rivlin", {"biaxial", "volumetric", "shear"}),
    good_material("material_plot", "all -plot all.svg", {"wrote all.svg"}, {}, expect_plot),
    good_material("material_gradients", "rotated_linear -lambda 4 -mu 6 -gradients f.txt -o p.csv",
                  {"wrote p.csv: 3 stresses"}, {gradients}, expect_stresses),
    good_material("material_gradients_to_the_screen", "spline -gradients f.txt",
                  {"sigma_1,sigma_2,sigma_3,P_11"}, {gradients}),
    bad_material("material_nothing", "", {"evert material needs a model: neo_hookean"}),
    bad_material("material_unknown", "neohookean", {"model", "did you mean 'neo_hookean'?"}),
    bad_material("material_unknown_option", "spline -elongation_limt 2",
                 {"did you mean '-elongation_limit'?"}),
    bad_material("material_incompressible", "neo_hookean -poissons_ratio 0.5",
                 {"evert material: poissons_ratio", "(-1, 0.5)"}),
    bad_material("material_of_another_model", "neo_hookean -elongation_limit 2",
                 {"elongation_limit", "only with spline"}),
    bad_material("material_limits_in_wrong_order", "spline -compression_limit 0.9 -elongation_limit 0.8",
                 {"elongation_limit", ">= 1"}),
    bad_material("material_in_two_ways", "neo_hookean -youngs_modulus 1 -mu 1", {"needs either"}),
    bad_material("material_odd_number", "neo_hookean -youngs_modulus stiff", {"youngs_modulus", "'stiff'"}),
    bad_material("material_unknown_path", "neo_hookean -path uniaxal", {"did you mean 'uniaxial'?"}),
    bad_material("material_empty_range", "neo_hookean -from 1 -to 1", {"-from must be less than -to"}),
    bad_material("material_range_of_rounding", "neo_hookean -plot a.svg -from 1 -to 1.0000000000000002",
                 {"-from must be less than -to"}),
    bad_material("material_one_point", "neo_hookean -points 1", {"-points must be from 2"}),
    bad_material("material_all_without_plot", "all", {"'all' goes with -plot only"}),
    bad_material("material_plot_of_gradients", "spline -plot a.svg -gradients f.txt", {"exclude each other"},
                 {gradients}),
    bad_material("material_output_of_nothing", "spline -o p.csv", {"-o goes with -gradients only"}),
    bad_material("material_plot_to_nowhere", "spline -plot /proc/a.svg", {"/proc/a.svg"}),
    bad_material("material_no_gradients", "spline -gradients f.txt", {"f.txt: there is no such file"}),
    bad_material("material_gradients_is_directory", "spline -gradients f.txt", {"f.txt: is a directory"},
                 {{"f.txt/"}}),
    bad_material("material_empty_gradients", "spline -gradients f.txt", {"holds no deformation gradient"},
                 {{"f.txt", "# nothing\n"}}),
    bad_material("material_eight_numbers", "spline -gradients f.txt", {"f.txt:2: holds 8 numbers", "has 9"},
                 {{"f.txt", "1 0 0 0 1 0 0 0 1\n1 0 0 0 1 0 0 0\n"}}),
    bad_material("material_gradient_of_words", "spline -gradients f.txt", {"f.txt:1: '1.0e' is no finite"},
                 {{"f.txt", "1.0e 0 0 0 1 0 0 0 1\n"}}),
    bad_material("material_gradient_not_finite", "spline -gradients f.txt", {"'nan' is no finite number"},
                 {{"f.txt", "nan 0 0 0 1 0 0 0 1\n"}}),
    bad_material("material_gradient_too_large", "spline -gradients f.txt", {"'1e999' does not fit"},
                 {{"f.txt", "1e999 0 0 0 1 0 0 0 1\n"}}),
    good_material(
        "material_muscle_along", "muscle -activation 1 -path uniaxial -from 1 -to 2 -points 2",
        {"uniaxial: principal stretches (s, 1, 1)", "1          300000               0               0"}),
    good_material("material_muscle_across", "muscle -activation 1 -path across -from 1 -to 2 -points 2",
                  {"across: principal stretches (1, s, 1)", "1          300000"}),
    good_material("material_muscle_turned",
                  "muscle -activation 0.5 -fibre 0,0,2 -path uniaxial -from 1 -to 2 -points 2",
                  {"1               0               0               0          150000"}),
    good_material("material_tendon_plot", "tendon -plot tendon.svg", {"wrote tendon.svg"}),
    bad_material("material_too_active", "muscle -activation 1.1", {"-activation must be in [0, 1], not 1.1"}),
    bad_material("material_active_tendon", "tendon -activation 1", {"-activation goes with muscle only"}),
    bad_material("material_fibre_of_isotropic", "spline -fibre 1,0,0",
                 {"-fibre goes with muscle and tendon only"}),
    bad_material("material_fibre_of_no_direction", "muscle -fibre 0,0,0", {"-fibre must not be 0,0,0"}),
    bad_material("material_fibre_of_words", "muscle -fibre x", {"-fibre must be three finite numbers"}),
    bad_material("material_across_isotropic", "spline -path across", {"-path is 'across': must be"}),
};

}  // namespace

std::vector<Case> material_cases() { return cases; }

}  // namespace evert::cli
