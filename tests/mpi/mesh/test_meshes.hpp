#pragma once
#include "evert/mesh/mesh.hpp"

#include <array>

/// Small meshes for tests of distribution and output.
namespace evert::test {

/// Unit cube of n³ cells of 6 tetrahedra (Kuhn), in one region.
inline Mesh tet_cube(GlobalIndex n) {
  const auto node = [n](GlobalIndex i, GlobalIndex j, GlobalIndex k) {
    return (k * (n + 1) + j) * (n + 1) + i;
  };
  Mesh mesh;
  for (GlobalIndex k = 0; k <= n; ++k)
    for (GlobalIndex j = 0; j <= n; ++j)
      for (GlobalIndex i = 0; i <= n; ++i)
        mesh.nodes.push_back({double(i) / double(n), double(j) / double(n), double(k) / double(n)});
  CellBlock tets{CellType::tet4, {}, {}};
  for (GlobalIndex k = 0; k < n; ++k)
    for (GlobalIndex j = 0; j < n; ++j)
      for (GlobalIndex i = 0; i < n; ++i) {
        const std::array corner{node(i, j, k),         node(i + 1, j, k),        node(i, j + 1, k),
                                node(i + 1, j + 1, k), node(i, j, k + 1),        node(i + 1, j, k + 1),
                                node(i, j + 1, k + 1), node(i + 1, j + 1, k + 1)};
        // Paths from corner 0 to corner 7 along the axes; odd permutations are flipped to positive volume.
        constexpr std::array<std::array<std::size_t, 2>, 6> paths{
            {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}}};
        for (const auto& [a, b] : paths) {
          const auto first = (a == 1 || a == 2 || a == 4) ? a : b;
          const auto second = first == a ? b : a;
          const bool even = first == a;
          const auto p = corner[even ? first : second];
          const auto q = corner[even ? second : first];
          tets.nodes.insert(tets.nodes.end(), {corner[0], p, q, corner[7]});
          tets.region.push_back(0);
        }
      }
  mesh.cells.push_back(std::move(tets));
  mesh.regions = {"cube"};
  return mesh;
}

/// Two regions, three cell types, two node sets and two nodes of no cell (numbers 0 and 9): a row of `hexes`
/// hexahedra with a wedge at its end, and a tetrahedron apart from them in the second region.
inline Mesh mixed_row(GlobalIndex hexes) {
  Mesh mesh;
  mesh.nodes.push_back({-100, 0, 0});
  std::vector<GlobalIndex> slice;  // first node of each square slice
  for (GlobalIndex i = 0; i <= hexes; ++i) {
    if (i == 2) mesh.nodes.push_back({-200, 0, 0});
    slice.push_back(mesh.node_count());
    const auto x = static_cast<double>(i);
    for (const auto& [y, z] : std::array<std::array<double, 2>, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}})
      mesh.nodes.push_back({x, y, z});
  }
  CellBlock tets{CellType::tet4, {}, {}};
  CellBlock bricks{CellType::hex8, {}, {}};
  CellBlock wedges{CellType::wedge6, {}, {}};
  for (GlobalIndex i = 0; i < hexes; ++i) {
    const auto a = slice[static_cast<std::size_t>(i)];
    const auto b = slice[static_cast<std::size_t>(i) + 1];
    bricks.nodes.insert(bricks.nodes.end(), {a, a + 1, a + 2, a + 3, b, b + 1, b + 2, b + 3});
    bricks.region.push_back(static_cast<std::int32_t>(i % 2));
  }
  const auto end = slice.back();
  const auto roof = mesh.node_count();
  const auto x = static_cast<double>(hexes);
  mesh.nodes.push_back({x + 1, 0.5, 0});
  mesh.nodes.push_back({x + 1, 0.5, 1});
  wedges.nodes = {end, roof, end + 1, end + 3, roof + 1, end + 2};
  wedges.region = {0};
  const auto apart = mesh.node_count();
  for (const auto& p : std::array<Vec3d, 4>{{{0, 5, 0}, {1, 5, 0}, {0, 6, 0}, {0, 5, 1}}})
    mesh.nodes.push_back(p);
  tets.nodes = {apart, apart + 1, apart + 2, apart + 3};
  tets.region = {1};
  mesh.cells = {std::move(tets), std::move(bricks), std::move(wedges)};
  mesh.regions = {"soft", "stiff"};
  mesh.node_sets = {{"left", {0, 1, 2, 3, 4}}, {"roof", {roof, roof + 1}}};
  return mesh;
}

/// One tetrahedron.
inline Mesh single_tet() {
  Mesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.cells = {{CellType::tet4, {0, 1, 2, 3}, {0}}};
  mesh.regions = {"all"};
  return mesh;
}

}  // namespace evert::test
