#include "evert/core/error.hpp"
#include "evert/scene/reference.hpp"

#include <gtest/gtest.h>

namespace evert {
namespace {

std::string complaint(const std::string& query) {
  try {
    return reference_of(query);
  } catch (const UserError& error) {
    return error.what();
  }
}

TEST(Reference, says_all_about_a_key) {
  EXPECT_EQ(reference_of("obstacles.ground.friction"),
            "obstacles.<name>.friction\n"
            "  Coulomb coefficient.\n"
            "  type      number [-]\n"
            "  allowed   >= 0\n"
            "  default   0\n"
            "  example   friction: 0.3\n");
}

TEST(Reference, finds_keys_by_the_end_of_their_path) {
  const auto full = reference_of("bodies.<name>.material.poissons_ratio");
  EXPECT_EQ(full, reference_of("bodies.torus.material.poissons_ratio"));
  EXPECT_EQ(full, reference_of("bodies.material.poissons_ratio"));
  EXPECT_NE(full.find("in (-1, 0.5)"), std::string::npos);
  // in bodies and in groups
  EXPECT_NE(reference_of("poissons_ratio").find("bodies.<name>.groups.<name>.material"), std::string::npos);
}

TEST(Reference, explains_words) {
  const auto text = reference_of("bodies.torus.material.model");
  EXPECT_NE(text.find("neo_hookean, rotated_linear, st_venant_kirchhoff, mooney_rivlin, spline, "
                      "stable_neo_hookean, muscle or tendon"),
            std::string::npos);
  EXPECT_NE(text.find("linear in the stretches"), std::string::npos);
}

TEST(Reference, lists_the_keys_below) {
  EXPECT_NE(reference_of("checkpoint").find("every_simulated, every_wall"), std::string::npos);
}

TEST(Reference, suggests_for_unknown_keys) {
  EXPECT_EQ(
      complaint("youngs_modulu"),
      "'youngs_modulu' is no key of a scene (did you mean 'youngs_modulus'?); 'evert explain' lists all");
  EXPECT_NE(complaint("").find("is no key"), std::string::npos);
  EXPECT_NE(complaint(".").find("is no key"), std::string::npos);
  EXPECT_NE(complaint("bodies.torus.friction").find("is no key"), std::string::npos);
}

TEST(Reference, gives_every_key_help_and_an_example) {
  const auto page = reference_markdown();
  EXPECT_EQ(page.find("|  E.g."), std::string::npos) << "a key without help";
  EXPECT_EQ(page.find(": ` |"), std::string::npos) << "a key without an example";
  EXPECT_EQ(page.find("[] [] []"), std::string::npos);
}

}  // namespace
}  // namespace evert
