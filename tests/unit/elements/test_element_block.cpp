#include "evert/core/error.hpp"
#include "evert/elements/batching.hpp"
#include "evert/elements/element_block.hpp"
#include "evert/elements/reference_element.hpp"
#include "evert/elements/rest_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>

namespace evert {
namespace {

/// A box of unit cubes, each a hexahedron or six tetrahedra round its diagonal; interior nodes shaken a
/// little.
struct Box {
  std::vector<Vec3d> positions;
  std::vector<LocalIndex> tets;
  std::vector<LocalIndex> hexes;

  explicit Box(int n) {
    const auto id = [n](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> shake(-0.1, 0.1);
    for (int k = 0; k <= n; ++k) {
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i)
          positions.push_back({i + shake(random), j + shake(random), k + shake(random)});
      }
    }
    for (int k = 0; k < n; ++k) {
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          const LocalIndex v[8] = {
              id(i, j, k),     id(i + 1, j, k),     id(i + 1, j + 1, k),     id(i, j + 1, k),
              id(i, j, k + 1), id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)};
          hexes.insert(hexes.end(), v, v + 8);
          for (const auto& [a, b] : {std::pair{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}) {
            tets.insert(tets.end(), {v[0], v[a], v[b], v[6]});
          }
        }
      }
    }
  }
};

TEST(ElementBlock, KeepsEveryCellOnce) {
  const Box box(3);
  for (const int lanes : {1, 2, 4, 8}) {
    const auto block = make_element_block(tet4, box.tets, 50, box.positions, lanes);
    EXPECT_EQ(block.cells, 162);
    EXPECT_EQ(block.interior.end, (50 + lanes - 1) / lanes);
    EXPECT_EQ(block.batches() * lanes, static_cast<int>(block.cell_of_lane.size()));
    std::set<LocalIndex> seen;
    for (std::size_t slot = 0; slot < block.cell_of_lane.size(); ++slot) {
      const LocalIndex cell = block.cell_of_lane[slot];
      if (cell < 0) continue;
      EXPECT_TRUE(seen.insert(cell).second);
      EXPECT_EQ(cell < 50, static_cast<LocalIndex>(slot) < block.interior.end * lanes);
      for (std::size_t a = 0; a < 4; ++a) {
        const std::size_t batch = slot / static_cast<std::size_t>(lanes);
        const std::size_t lane = slot % static_cast<std::size_t>(lanes);
        EXPECT_EQ(block.nodes[(batch * 4 + a) * static_cast<std::size_t>(lanes) + lane],
                  box.tets[static_cast<std::size_t>(cell) * 4 + a]);
      }
    }
    EXPECT_EQ(seen.size(), 162U);
  }
}

TEST(ElementBlock, PaddingHasNoShapeAndTheNodesOfACell) {
  const Box box(2);
  for (LocalIndex cells = 1; cells <= 9; ++cells) {
    const std::span<const LocalIndex> nodes = std::span(box.tets).first(static_cast<std::size_t>(cells) * 4);
    const auto block = make_element_block(tet4, nodes, cells / 2, box.positions, 4);
    for (std::size_t slot = 0; slot < block.cell_of_lane.size(); ++slot) {
      if (block.cell_of_lane[slot] >= 0) continue;
      EXPECT_EQ(block.volumes[slot], 0);
      for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(block.shapes[(slot / 4 * 6 + i) * 4 + slot % 4], 0);
      for (std::size_t a = 0; a < 4; ++a) {
        const LocalIndex node = block.nodes[(slot / 4 * 4 + a) * 4 + slot % 4];
        EXPECT_NE(std::find(nodes.begin(), nodes.end(), node), nodes.end());
      }
    }
  }
}

double sum_of(const NumberArray& numbers) {
  double sum = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) sum += numbers[i];
  return sum;
}

TEST(ElementBlock, VolumesFillTheMesh) {
  const Box box(3);
  const double by_tets = sum_of(make_element_block(tet4, box.tets, 162, box.positions, 4).volumes);
  EXPECT_NEAR(by_tets, 27, 4);  // the surface is shaken
  Box flat(3);
  for (std::size_t i = 0; i < flat.positions.size(); ++i) {
    flat.positions[i] = {static_cast<double>(i % 4), static_cast<double>(i / 4 % 4),
                         static_cast<double>(i / 16)};
  }
  const double by_hexes = sum_of(make_element_block(hex8, flat.hexes, 27, flat.positions, 4).volumes);
  EXPECT_NEAR(by_hexes, 27, 1e-13);
}

/// The numbers of point `point` of a block of scalars, as vectors.
std::vector<Vec3d> vectors_of(const ElementBlock& block, std::size_t point) {
  const ShapeLayout layout = rest_layout(block.shape_data, block.element.nodes(), block.element.points());
  std::vector<Vec3d> vectors(layout.vectors, Vec3d{0, 0, 0});
  for (std::size_t j = 0; j < layout.vectors; ++j) {
    for (std::size_t i = 0; i < layout.components(j); ++i)
      vectors[j][i] = block.shapes[point * layout.numbers() + layout.begin(j) + i];
  }
  return vectors;
}

/// Gradients reproduce a linear field x = A X in their own frame: Σ (x_a − x_0) ⊗ ∂N_a/∂X = A Q.
void expect_linear_field_reproduced(const ElementView& element, std::span<const LocalIndex> cells,
                                    std::span<const Vec3d> positions) {
  const Mat3d a{{{{1.1, 0.2, -0.3}, {0.4, 0.7, 0.1}, {-0.2, 0.5, 1.3}}}};
  const auto block = make_element_block(element, cells, 0, positions, 1);
  const std::size_t nodes = element.nodes(), points = element.points();
  for (std::size_t point = 0; point < block.volumes.size(); ++point) {
    const auto position = [&](std::size_t n) {
      return positions[static_cast<std::size_t>(block.nodes[point / points * nodes + n])];
    };
    const std::vector<Vec3d> gradients = vectors_of(block, point);
    Mat3d f{}, q{};
    for (std::size_t n = 1; n < nodes; ++n) {
      f += outer(a * (position(n) - position(0)), gradients[n - 1]);
      q += outer(position(n) - position(0), gradients[n - 1]);
    }
    EXPECT_NEAR(norm(f - a * q), 0, 1e-14);
    EXPECT_NEAR(norm(times_transpose(q, q) - identity<double>()), 0, 1e-14);
    EXPECT_NEAR(determinant(q), 1, 1e-14);
  }
}

TEST(ElementBlock, GradientsReproduceALinearField) {
  const Box box(2);
  expect_linear_field_reproduced(tet4, box.tets, box.positions);
  expect_linear_field_reproduced(hex8, box.hexes, box.positions);
}

TEST(TriangularFrame, TurnsWhateverItIsGiven) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3d{normal(random), normal(random), normal(random)}; };
  for (int i = 0; i < 2000; ++i) {
    Mat3d v{vector(), vector(), vector()};
    if (i % 5 == 1) v.column[1] = 2.5 * v.column[0];              // no plane
    if (i % 5 == 2) v.column[2] = v.column[0] + 1e-9 * vector();  // a sliver
    if (i % 5 == 3) v.column[static_cast<std::size_t>(i) % 3] = {0, 0, 0};
    if (i % 5 == 4) v = std::pow(10.0, i % 7 * 20 - 60) * v;
    const Mat3d q = triangular_frame(v);
    EXPECT_NEAR(norm(times_transpose(q, q) - identity<double>()), 0, 2e-15);
    EXPECT_NEAR(determinant(q), 1, 2e-15);
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3d turned = transpose_times(q, v.column[j]);
      for (std::size_t k = j + 1; k < 3; ++k) EXPECT_LE(std::abs(turned[k]), 1e-15 * norm(v.column[j])) << i;
    }
  }
}

TEST(BatchOrder, PutsStrangersIntoABatch) {
  const Box box(8);
  std::vector<LocalIndex> cells(box.tets.size() / 4);
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = static_cast<LocalIndex>(i);
  std::shuffle(cells.begin(), cells.end(), std::mt19937_64(5));
  const int lanes = 4;
  const auto order = batch_order(cells, box.tets, 4, lanes);
  EXPECT_EQ(std::set(order.begin(), order.end()).size(), cells.size());
  int sharing = 0;
  for (std::size_t first = 0; first + lanes <= order.size(); first += lanes) {
    std::set<LocalIndex> nodes;
    for (std::size_t l = 0; l < lanes; ++l) {
      const auto begin = box.tets.begin() + 4 * order[first + l];
      nodes.insert(begin, begin + 4);
    }
    sharing += nodes.size() < 4 * lanes;
  }
  // All but the tail, where the window runs dry.
  EXPECT_LE(sharing, static_cast<int>(order.size() / lanes) / 50);
}

TEST(ElementBlock, RefusesCellsWithoutVolume) {
  Box box(2);
  std::swap(box.tets[4 * 7], box.tets[4 * 7 + 1]);  // inside out
  box.tets[4 * 11 + 1] = box.tets[4 * 11];          // flat
  try {
    static_cast<void>(make_element_block(tet4, box.tets, 0, box.positions, 4));
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_NE(
        std::string(error.what()).find("2 of 48 tet4 cells have zero or negative rest volume (first: 7 11)"),
        std::string::npos)
        << error.what();
  }
  EXPECT_EQ(cells_without_volume(tet4, box.tets, box.positions), (std::vector<LocalIndex>{7, 11}));
}

TEST(ElementBlock, RefusesAbsurdCoordinates) {
  const Box box(1);
  for (const double scale : {0.0, 1e-120, 1e150, std::numeric_limits<double>::quiet_NaN()}) {
    std::vector<Vec3d> positions;
    for (const Vec3d& x : box.positions) positions.push_back(scale * x);
    EXPECT_EQ(cells_without_volume(tet4, box.tets, positions).size(), 6U) << scale;
    EXPECT_EQ(cells_without_volume(hex8, box.hexes, positions).size(), 1U) << scale;
  }
}

TEST(ElementBlock, EmptyListMakesAnEmptyBlock) {
  const auto block = make_element_block(tet4, {}, 0, {}, 4);
  EXPECT_EQ(block.batches(), 0);
  EXPECT_EQ(block.shapes.size(), 0);
}

}  // namespace
}  // namespace evert
