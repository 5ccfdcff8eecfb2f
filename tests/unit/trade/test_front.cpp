#include "evert/trade/front.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace evert::trade {
namespace {

Trial trial(const std::string& label, double cost, double error, Fate fate = Fate::finished) {
  Trial t{.choice = {0}, .label = label, .fate = fate, .message = "", .cost = cost, .errors = {}};
  t.errors.displacement = error;
  return t;
}

TEST(ParetoFront, HasWhatNothingBeatsInBoth) {
  const std::vector<Trial> trials{trial("dear", 9, 0.01),
                                  trial("beaten", 5, 0.2),
                                  trial("cheap", 1, 0.5),
                                  trial("middle", 4, 0.1),
                                  trial("equal", 4, 0.1),
                                  trial("useless", 10, 0.01),
                                  trial("exploded", 0.1, 0, Fate::unstable)};
  EXPECT_EQ(pareto_front(trials), (std::vector<std::size_t>{2, 3, 0}));
  EXPECT_TRUE(pareto_front(std::vector<Trial>{}).empty());
}

TEST(Front, TheTableSaysWhatDidNotFinish) {
  auto broken = trial("dt 1", 0.1, 0, Fate::unstable);
  broken.message = "not finite";
  const std::vector<Trial> trials{trial("dt 0.1", 2, 0.05), broken};
  const auto table = table_of(trials, pareto_front(trials));
  EXPECT_NE(table.find("unstable: not finite"), std::string::npos) << table;
  EXPECT_NE(table.find("5 %"), std::string::npos) << table;
  EXPECT_LT(table.find("dt 1 "), table.find("dt 0.1")) << "by cost";
}

TEST(Front, TheCsvHasARowForEachSetting) {
  const std::vector<Axis> axes{
      {.key = "bodies.*.mesh.cells", .values = {"[4,2,2]"}, .numbers = {16}, .overrides = {{}}}};
  auto broken = trial("", 0.1, 0, Fate::too_slow);
  broken.message = "a \"word\"";
  const std::vector<Trial> trials{trial("", 2, 0.05), broken};
  const auto csv = csv_of(axes, trials, pareto_front(trials));
  EXPECT_NE(csv.find("\n\"[4,2,2]\",finished,1,2,0.05,0,0,0,0,0,0,0,\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("too slow,,0.1,,,,,,0,0,0,\"a \"\"word\"\"\"\n"), std::string::npos) << csv;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Front, ThePlotShowsAllAndNamesTheFront) {
  const std::vector<Trial> trials{trial("cell <a>", 0.01, 0.5), trial("b", 10, 0.001), trial("c", 20, 0.4),
                                  trial("d", 0.02, 0, Fate::unstable)};
  const auto svg = plot_of("A & B", trials, pareto_front(trials), 1e-4);
  EXPECT_TRUE(svg.starts_with("<svg"));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_NE(svg.find("A &amp; B"), std::string::npos);
  EXPECT_NE(svg.find("1  cell &lt;a>: 50 %"), std::string::npos);
  EXPECT_NE(svg.find("CPU s per simulated s"), std::string::npos);
  EXPECT_NE(svg.find("error of the displacement [%]"), std::string::npos);
  EXPECT_EQ(count(svg, "r=\"10\""), 2U) << "the front";
  EXPECT_EQ(count(svg, "r=\"4.5\""), 2U) << "one beaten, and the key";
  EXPECT_EQ(count(svg, "l10,10m0,-10"), 2U) << "one unstable, and the key";
  EXPECT_EQ(count(svg, "nan") + count(svg, "inf"), 0U);
}

TEST(Front, ThePlotOfNothingIsAPage) {
  const auto svg = plot_of("none", std::vector<Trial>{}, {}, 0);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_EQ(count(svg, "nan") + count(svg, "inf"), 0U);
}

}  // namespace
}  // namespace evert::trade
