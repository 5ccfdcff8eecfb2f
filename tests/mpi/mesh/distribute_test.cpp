#include "evert/core/collective.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <gtest/gtest.h>

#include "test_meshes.hpp"
#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace evert {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

/// Every rank's values one after the other, on every rank.
template <class T>
std::vector<T> gather(const std::vector<T>& mine) {
  int bytes = static_cast<int>(mine.size() * sizeof(T));
  std::vector<int> counts(static_cast<std::size_t>(size_of(world)));
  MPI_Allgather(&bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  std::vector<int> offsets(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
  std::vector<T> all(static_cast<std::size_t>(offsets.back() + counts.back()) / sizeof(T));
  MPI_Allgatherv(mine.data(), bytes, MPI_BYTE, all.data(), counts.data(), offsets.data(), MPI_BYTE, world);
  return all;
}

/// Only rank 0 has the mesh, as in a run.
DistributedMesh distribute_from_root(const Mesh& mesh, Partitioner partitioner = Partitioner::metis) {
  return distribute(world, rank_of(world) == 0 ? mesh : Mesh{}, {partitioner});
}

struct Case {
  const char* name;
  Mesh mesh;
  Partitioner partitioner = Partitioner::metis;
};

std::vector<Case> cases() {
  return {{"cube", test::tet_cube(5)},
          {"mixed", test::mixed_row(6)},
          {"ptscotch", test::tet_cube(5), Partitioner::ptscotch},
          {"mixed by ptscotch", test::mixed_row(6), Partitioner::ptscotch}};
}

std::vector<bool> used_nodes(const Mesh& mesh) {
  std::vector<bool> used(mesh.nodes.size());
  for (const auto& block : mesh.cells)
    for (const auto node : block.nodes) used[static_cast<std::size_t>(node)] = true;
  return used;
}

struct CellRecord {
  GlobalIndex id;
  int type;
  int region;
  std::array<GlobalIndex, 10> nodes;
  auto operator<=>(const CellRecord&) const = default;
};

std::vector<CellRecord> records_of(const Mesh& mesh) {
  std::vector<CellRecord> records;
  for (const auto& block : mesh.cells) {
    const auto n = static_cast<std::size_t>(node_count(block.type));
    for (std::size_t c = 0; c < block.region.size(); ++c) {
      records.push_back(
          {static_cast<GlobalIndex>(records.size()), static_cast<int>(block.type), block.region[c], {}});
      std::copy_n(block.nodes.begin() + static_cast<std::ptrdiff_t>(c * n), n, records.back().nodes.begin());
    }
  }
  return records;
}

std::vector<CellRecord> records_of(const DistributedMesh& mesh) {
  std::vector<CellRecord> records;
  for (const auto& cells : mesh.cells) {
    const auto n = static_cast<std::size_t>(node_count(cells.type));
    for (std::size_t c = 0; c < cells.global_ids.size(); ++c) {
      records.push_back({cells.global_ids[c], static_cast<int>(cells.type), cells.region, {}});
      for (std::size_t i = 0; i < n; ++i)
        records.back().nodes[i] = mesh.original_nodes[static_cast<std::size_t>(cells.nodes[c * n + i])];
    }
  }
  return records;
}

TEST(Distribute, GivesEveryCellToOneRankUnchanged) {
  for (const auto& [name, mesh, partitioner] : cases()) {
    SCOPED_TRACE(name);
    const auto part = distribute_from_root(mesh, partitioner);
    auto all = gather(records_of(part));
    std::sort(all.begin(), all.end());
    EXPECT_EQ(all, records_of(mesh));
    EXPECT_EQ(part.total_cells, mesh.cell_count());
    EXPECT_FALSE(records_of(part).empty());
    EXPECT_EQ(part.regions, mesh.regions);
  }
}

/// A vector that says which cell it belongs to.
Vec3d vector_of(GlobalIndex cell) {
  return {static_cast<double>(cell), 0.5, -1.0 / static_cast<double>(cell + 1)};
}

TEST(Distribute, SendsTheVectorOfACellWithIt) {
  auto all = cases();
  for (auto& [name, mesh, partitioner] : all) {
    SCOPED_TRACE(name);
    for (const auto& cells : distribute_from_root(mesh, partitioner).cells)
      EXPECT_TRUE(cells.vectors.empty()) << "there are none";
    GlobalIndex number = 0;
    for (auto& block : mesh.cells)
      for (GlobalIndex i = 0; i < block.size(); ++i) block.vectors.push_back(vector_of(number++));
    for (const auto& cells : distribute_from_root(mesh, partitioner).cells) {
      ASSERT_EQ(cells.vectors.size(), cells.global_ids.size());
      for (std::size_t i = 0; i < cells.vectors.size(); ++i)
        EXPECT_EQ(cells.vectors[i], vector_of(cells.global_ids[i]));
    }
  }
}

TEST(Distribute, ListsTheSameCellListsEverywhere) {
  const auto mesh = test::mixed_row(6);
  const auto part = distribute_from_root(mesh);
  std::vector<std::pair<CellType, int>> lists;
  for (const auto& cells : part.cells) lists.emplace_back(cells.type, cells.region);
  EXPECT_EQ(lists,
            (std::vector<std::pair<CellType, int>>{
                {CellType::tet4, 1}, {CellType::hex8, 0}, {CellType::hex8, 1}, {CellType::wedge6, 0}}));
}

TEST(Distribute, GivesEveryUsedNodeToOneRank) {
  for (const auto& [name, mesh, partitioner] : cases()) {
    SCOPED_TRACE(name);
    const auto part = distribute_from_root(mesh, partitioner);
    ASSERT_EQ(part.original_nodes.size(), static_cast<std::size_t>(part.local_nodes()));
    const auto owned =
        gather(std::vector(part.original_nodes.begin(), part.original_nodes.begin() + part.owned_nodes));
    const auto used = used_nodes(mesh);
    EXPECT_EQ(static_cast<std::ptrdiff_t>(owned.size()), std::count(used.begin(), used.end(), true));
    EXPECT_EQ(std::set(owned.begin(), owned.end()).size(), owned.size());
    for (const auto node : owned) EXPECT_TRUE(used[static_cast<std::size_t>(node)]);
    EXPECT_EQ(part.total_nodes, static_cast<GlobalIndex>(owned.size()));
    for (std::size_t i = 0; i < part.original_nodes.size(); ++i)
      EXPECT_EQ(part.rest_positions[i], mesh.nodes[static_cast<std::size_t>(part.original_nodes[i])]);
  }
}

TEST(Distribute, NumbersOwnedNodesOneRankAfterTheOther) {
  const auto part = distribute_from_root(test::tet_cube(4));
  const auto firsts = gather(std::vector{part.first_owned});
  const auto owned = gather(std::vector{part.owned_nodes});
  GlobalIndex expected = 0;
  for (std::size_t rank = 0; rank < firsts.size(); ++rank) {
    EXPECT_EQ(firsts[rank], expected);
    expected += owned[rank];
  }
}

TEST(Distribute, NaturalNumbersFollowTheOriginalOnesWithoutGaps) {
  for (const auto& [name, mesh, partitioner] : cases()) {
    SCOPED_TRACE(name);
    const auto part = distribute_from_root(mesh, partitioner);
    ASSERT_EQ(part.natural_nodes.size(), static_cast<std::size_t>(part.owned_nodes));
    const auto used = used_nodes(mesh);
    for (std::size_t i = 0; i < part.natural_nodes.size(); ++i)
      EXPECT_EQ(part.natural_nodes[i], std::count(used.begin(), used.begin() + part.original_nodes[i], true));
  }
}

TEST(Distribute, GhostsAreSortedAndNameTheirOwnersNode) {
  for (const auto& [name, mesh, partitioner] : cases()) {
    SCOPED_TRACE(name);
    const auto part = distribute_from_root(mesh, partitioner);
    const auto owned =
        gather(std::vector(part.original_nodes.begin(), part.original_nodes.begin() + part.owned_nodes));
    ASSERT_EQ(part.ghost_globals.size(), static_cast<std::size_t>(part.ghost_nodes));
    EXPECT_TRUE(std::is_sorted(part.ghost_globals.begin(), part.ghost_globals.end()));
    for (std::size_t g = 0; g < part.ghost_globals.size(); ++g) {
      EXPECT_FALSE(part.ghost_globals[g] >= part.first_owned &&
                   part.ghost_globals[g] < part.first_owned + part.owned_nodes);
      EXPECT_EQ(owned.at(static_cast<std::size_t>(part.ghost_globals[g])),
                part.original_nodes[static_cast<std::size_t>(part.owned_nodes) + g]);
    }
  }
}

TEST(Distribute, InteriorCellsComeFirstAndTouchNoGhost) {
  for (const auto& [name, mesh, partitioner] : cases()) {
    SCOPED_TRACE(name);
    const auto part = distribute_from_root(mesh, partitioner);
    for (const auto& cells : part.cells) {
      const auto n = static_cast<std::size_t>(node_count(cells.type));
      for (std::size_t c = 0; c < cells.global_ids.size(); ++c) {
        const auto nodes = std::span(cells.nodes).subspan(c * n, n);
        const bool touches_ghost = *std::max_element(nodes.begin(), nodes.end()) >= part.owned_nodes;
        EXPECT_EQ(touches_ghost, static_cast<LocalIndex>(c) >= cells.interior);
      }
    }
  }
}

TEST(Distribute, NodeSetsKeepTheirUsedNodes) {
  const auto mesh = test::mixed_row(6);
  const auto part = distribute_from_root(mesh);
  const auto used = used_nodes(mesh);
  ASSERT_EQ(part.node_sets.size(), mesh.node_sets.size());
  for (std::size_t s = 0; s < mesh.node_sets.size(); ++s) {
    EXPECT_EQ(part.node_sets[s].name, mesh.node_sets[s].name);
    EXPECT_TRUE(std::is_sorted(part.node_sets[s].owned.begin(), part.node_sets[s].owned.end()));
    std::vector<GlobalIndex> originals;
    for (const auto node : part.node_sets[s].owned) {
      ASSERT_LT(node, part.owned_nodes);
      originals.push_back(part.original_nodes[static_cast<std::size_t>(node)]);
    }
    auto all = gather(originals);
    std::sort(all.begin(), all.end());
    std::vector<GlobalIndex> expected;
    std::copy_if(mesh.node_sets[s].nodes.begin(), mesh.node_sets[s].nodes.end(), std::back_inserter(expected),
                 [&](GlobalIndex node) { return used[static_cast<std::size_t>(node)]; });
    EXPECT_EQ(all, expected);
  }
}

/// Mean distance in memory between the nodes of a cell.
double mean_spread(const DistributedMesh& mesh) {
  double sum = 0;
  double count = 0;
  for (const auto& cells : mesh.cells)
    for (std::size_t c = 0; c < cells.nodes.size(); c += 4) {
      const auto nodes = std::span(cells.nodes).subspan(c, 4);
      if (*std::max_element(nodes.begin(), nodes.end()) >= mesh.owned_nodes) continue;
      const auto [low, high] = std::minmax_element(nodes.begin(), nodes.end());
      sum += *high - *low;
      count += 1;
    }
  return count > 0 ? sum / count : 0;
}

TEST(Distribute, RenumbersScrambledNodesForLocality) {
  auto mesh = test::tet_cube(8);
  const auto nodes = static_cast<std::size_t>(mesh.node_count());
  const auto scrambled = [&](GlobalIndex node) {
    return node * 367 % mesh.node_count();
  };  // 367 and 729 are coprime
  auto positions = mesh.nodes;
  for (std::size_t i = 0; i < nodes; ++i)
    positions[static_cast<std::size_t>(scrambled(static_cast<GlobalIndex>(i)))] = mesh.nodes[i];
  mesh.nodes = positions;
  for (auto& node : mesh.cells.front().nodes) node = scrambled(node);
  // A slice of the cube has 81 nodes; scrambled cells would spread over half of all.
  EXPECT_LT(mean_spread(distribute_from_root(mesh)), 130);
}

TEST(Distribute, IsRepeatable) {
  const auto mesh = test::tet_cube(4);
  const auto once = distribute_from_root(mesh);
  const auto twice = distribute_from_root(mesh);
  EXPECT_EQ(once.original_nodes, twice.original_nodes);
  EXPECT_EQ(once.ghost_globals, twice.ghost_globals);
  EXPECT_EQ(records_of(once), records_of(twice));
}

TEST(Distribute, BalancesCells) {
  const auto part = distribute_from_root(test::tet_cube(8));
  const auto mine = records_of(part).size();
  const auto fair = static_cast<double>(part.total_cells) / size_of(world);
  EXPECT_LT(static_cast<double>(mine), 1.1 * fair);
}

TEST(Distribute, MoreRanksThanCellsIsAnErrorOnEveryRank) {
  for (const auto partitioner : {Partitioner::metis, Partitioner::ptscotch}) {
    if (size_of(world) == 1) {
      EXPECT_EQ(distribute_from_root(test::single_tet(), partitioner).owned_nodes, 4);
      continue;
    }
    try {
      static_cast<void>(distribute_from_root(test::single_tet(), partitioner));
      ADD_FAILURE() << "no error";
    } catch (const UserError& error) {
      EXPECT_EQ(std::string(error.what()),
                "cannot spread 1 cell over " + std::to_string(size_of(world)) + " ranks: use at most 1");
    }
  }
}

TEST(Distribute, NoCellsIsAnErrorOnEveryRank) { EXPECT_THROW(distribute_from_root(Mesh{}), UserError); }

TEST(Distribute, AsManyCellsAsRanksGivesEachRankOne) {
  Mesh mesh = test::single_tet();
  for (int i = 1; i < size_of(world); ++i) {
    const auto next = mesh.node_count();
    mesh.nodes.push_back({double(i), 1, 1});
    auto& block = mesh.cells.front();
    block.nodes.insert(block.nodes.end(), {next - 3, next - 2, next - 1, next});
    block.region.push_back(0);
  }
  for (const auto partitioner : {Partitioner::metis, Partitioner::ptscotch})
    EXPECT_EQ(records_of(distribute_from_root(mesh, partitioner)).size(), 1U);
}

}  // namespace
}  // namespace evert
