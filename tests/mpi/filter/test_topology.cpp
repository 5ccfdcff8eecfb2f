// Filters after a change of topology: of the elements near it alone, and the same as if made from nothing.
#include "evert/mesh/generators.hpp"

#include <gtest/gtest.h>

#include "filtered_body.hpp"
#include <algorithm>
#include <random>
#include <set>

namespace evert::test {
namespace {

using Tet = std::array<GlobalIndex, 4>;

double volume_of(const Mesh& mesh, const Tet& tet) {
  const auto at = [&](std::size_t a) { return mesh.nodes[static_cast<std::size_t>(tet[a])]; };
  return dot(at(3) - at(0), cross(at(1) - at(0), at(2) - at(0))) / 6;
}

std::vector<Tet> tets_of(const Mesh& mesh) {
  const auto& nodes = mesh.cells.front().nodes;
  std::vector<Tet> all(nodes.size() / 4);
  for (std::size_t i = 0; i < nodes.size(); ++i) all[i / 4][i % 4] = nodes[i];
  return all;
}

/// A mesh before and after, and where its cells come from.
struct Replaced {
  Mesh mesh;
  std::vector<GlobalIndex> origins;  // per cell, −1: new
  std::set<GlobalIndex> changed;     // nodes
};

/// Replaces the first two neighbours from cell number `from` on that allow it by three tetrahedra around a
/// new edge.
Replaced with_edge_in_place_of_face(const Mesh& mesh, std::size_t from) {
  const auto tets = tets_of(mesh);
  for (std::size_t i = from; i < tets.size(); ++i)
    for (std::size_t j = i + 1; j < tets.size(); ++j) {
      std::vector<GlobalIndex> face;
      for (const auto node : tets[i])
        if (std::ranges::find(tets[j], node) != tets[j].end()) face.push_back(node);
      if (face.size() != 3) continue;
      const auto apex = [&](const Tet& tet) {
        return *std::ranges::find_if(tet,
                                     [&](auto node) { return std::ranges::find(face, node) == face.end(); });
      };
      std::array<Tet, 3> around;
      double smallest = 1, before = volume_of(mesh, tets[i]) + volume_of(mesh, tets[j]);
      for (std::size_t k = 0; k < 3; ++k) {
        around[k] = {face[k], face[(k + 1) % 3], apex(tets[i]), apex(tets[j])};
        if (volume_of(mesh, around[k]) < 0) std::swap(around[k][0], around[k][1]);
        smallest = std::min(smallest, volume_of(mesh, around[k]));
        before -= volume_of(mesh, around[k]);
      }
      if (!(smallest > 1e-6) || std::abs(before) > 1e-12) continue;  // the edge would leave the two
      Replaced after{mesh, {}, {face.begin(), face.end()}};
      after.changed.insert({apex(tets[i]), apex(tets[j])});
      auto& block = after.mesh.cells.front();
      block.nodes.clear();
      block.region.clear();
      const auto add = [&](const Tet& tet, GlobalIndex origin) {
        block.nodes.insert(block.nodes.end(), tet.begin(), tet.end());
        block.region.push_back(0);
        after.origins.push_back(origin);
      };
      for (std::size_t c = 0; c < tets.size(); ++c)
        if (c != i && c != j) add(tets[c], static_cast<GlobalIndex>(c));
      for (const auto& tet : around) add(tet, -1);
      return after;
    }
  throw std::logic_error("no two cells of the mesh can be replaced");
}

/// In the numbers of a rank that has all of it.
TopologyChange change_of(const Replaced& replaced, const DistributedMesh& before,
                         const DistributedMesh& after) {
  std::map<GlobalIndex, LocalIndex> number_before;
  for (const auto& entry : before.cells)
    for (const GlobalIndex cell : entry.global_ids)
      number_before.emplace(cell, static_cast<LocalIndex>(number_before.size()));
  TopologyChange change;
  for (const auto& entry : after.cells)
    for (const GlobalIndex cell : entry.global_ids) {
      const GlobalIndex origin = replaced.origins[static_cast<std::size_t>(cell)];
      change.origins.push_back(origin < 0 ? -1 : number_before.at(origin));
    }
  for (LocalIndex i = 0; i < after.local_nodes(); ++i)
    change.changed.push_back(replaced.changed.contains(after.original_nodes[static_cast<std::size_t>(i)]));
  return change;
}

class Topology : public testing::TestWithParam<FilterSelection> {};

TEST_P(Topology, FiltersAnewOnlyWhereElementsAreReplaced) {
  Mesh box = generate_box({{2, 1, 1}}, {16, 8, 8}, BoxCells::tet6);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> shift(-0.04, 0.04);
  for (auto& node : box.nodes) node += Vec3d{shift(random), shift(random), shift(random)};
  reorient(box);
  const auto mesh = distribute(PETSC_COMM_SELF, box);
  FilteredBody body(mesh, 1000);
  const auto options = at_step(1.5 * 2 / std::sqrt(body.largest_eigenvalue()), GetParam());
  const ModalFilter filter(mesh, body.elastic, options);
  ASSERT_GT(filter.filtered_cells(), 0);

  const auto replaced = with_edge_in_place_of_face(box, box.cells.front().region.size() / 2);
  const auto mesh_after = distribute(PETSC_COMM_SELF, replaced.mesh);
  FilteredBody cut(mesh_after, 1000), fresh(mesh_after, 1000);
  const ModalFilter kept(filter, mesh_after, cut.elastic, change_of(replaced, mesh, mesh_after));
  EXPECT_LE(cut.largest_eigenvalue(), options.limit() * (1 + 1e-9));
  if (GetParam() == FilterSelection::adaptive)
    return;  // it looks at the whole body, and softens what it must
  EXPECT_LT(kept.looked_at(), mesh_after.total_cells / 4);
  const ModalFilter expected(mesh_after, fresh.elastic, options);
  double worst = 0;
  for (std::size_t c = 0; c < kept.clamps().size(); ++c)
    worst = std::max(worst, difference(kept.clamps()[c], expected.clamps()[c]));
  EXPECT_LE(worst, 1e-12);
  EXPECT_NEAR(cut.largest_eigenvalue(), fresh.largest_eigenvalue(), 1e-9 * options.limit());
}

INSTANTIATE_TEST_SUITE_P(Selections, Topology,
                         testing::Values(FilterSelection::paper, FilterSelection::spare_mass,
                                         FilterSelection::adaptive));

}  // namespace
}  // namespace evert::test
