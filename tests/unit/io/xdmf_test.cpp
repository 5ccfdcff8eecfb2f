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

TEST(Xdmf, EscapesTheNameOfTheFile) {
  const auto text = xdmf_text({"a&<b>.h5", 11, {{CellType::tet4, 8}}}, {{{"/frames/00000000", 0, {}}}});
  EXPECT_TRUE(contains(text, ">a&amp;&lt;b&gt;.h5:/mesh"));
}

}  // namespace
}  // namespace evert
