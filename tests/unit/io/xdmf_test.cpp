#include "xdmf.hpp"

#include <gtest/gtest.h>

namespace evert {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Xdmf, OneCellTypeRefersToItsOwnTable) {
  const auto text = xdmf_text({"run.h5", 11, {{CellType::tet4, 8}}}, {{{"/frames/00000000", 0.1, {}}}});
  EXPECT_TRUE(contains(text, "<Topology TopologyType=\"Tetrahedron\" NumberOfElements=\"8\">"));
  EXPECT_TRUE(contains(
      text, "Dimensions=\"8 4\" NumberType=\"Int\" Precision=\"8\" Format=\"HDF\">run.h5:/mesh/cells/tet4<"));
  EXPECT_TRUE(contains(text, "Dimensions=\"11 3\""));
  EXPECT_TRUE(contains(text, "<Time Value=\"0.1\"/>"));
}

TEST(Xdmf, SeveralCellTypesShareAMixedTable) {
  const std::vector<std::pair<CellType, GlobalIndex>> blocks{
      {CellType::tet4, 2}, {CellType::hex8, 3}, {CellType::tet10, 1}};
  EXPECT_EQ(mixed_length(blocks), 2 * 5 + 3 * 9 + 11);
  const auto text = xdmf_text({"run.h5", 40, blocks}, {{{"/frames/00000000", 0, {}}}});
  EXPECT_TRUE(contains(text, "<Topology TopologyType=\"Mixed\" NumberOfElements=\"6\">"));
  EXPECT_TRUE(contains(
      text,
      "<DataItem Dimensions=\"48\" NumberType=\"Int\" Precision=\"8\" Format=\"HDF\">run.h5:/mesh/mixed<"));
}

TEST(Xdmf, SaysNothingOfFieldsThatAreNotThere) {
  const auto text = xdmf_text({"run.h5", 11, {{CellType::tet4, 8}}},
                              {{{"/frames/00000000", 0, {false, false, false, false}}}});
  for (const auto* field : {"velocity", "min_stretch", "inverted", "rank"})
    EXPECT_FALSE(contains(text, field)) << field;
  EXPECT_TRUE(contains(text, "region"));
}

TEST(Xdmf, PutsObstaclesBesideTheBodies) {
  const WrittenFrame frame{
      "/frames/00000003", 0.3, {}, {{"ball", "/frames/00000001/obstacles/ball", 42, 80}}};
  const auto text = xdmf_text({"run.h5", 11, {{CellType::tet4, 8}}}, std::vector{frame});
  EXPECT_TRUE(contains(text, "GridType=\"Collection\" CollectionType=\"Spatial\""));
  EXPECT_TRUE(contains(text, "<Topology TopologyType=\"Triangle\" NumberOfElements=\"80\">"));
  EXPECT_TRUE(contains(text, ">run.h5:/obstacles/ball/triangles<"));
  EXPECT_TRUE(contains(text,
                       "Dimensions=\"42 3\" NumberType=\"Float\" Precision=\"8\" "
                       "Format=\"HDF\">run.h5:/frames/00000001/obstacles/ball<"));
  EXPECT_EQ(text.find("<Time"), text.rfind("<Time")) << "one time a frame";
}

TEST(Xdmf, EscapesTheNameOfTheFile) {
  const auto text = xdmf_text({"a&<b>.h5", 11, {{CellType::tet4, 8}}}, {{{"/frames/00000000", 0, {}}}});
  EXPECT_TRUE(contains(text, ">a&amp;&lt;b&gt;.h5:/mesh"));
}

}  // namespace
}  // namespace evert
