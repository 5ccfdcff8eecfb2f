// Cells with a block of their own: what the forces of a body make of them.
#include "evert/filter/element_limits.hpp"
#include "evert/filter/mode_energy.hpp"
#include "evert/mesh/generators.hpp"

#include <gtest/gtest.h>

#include "filtered_body.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace evert::test {
namespace {

constexpr Lame lame = Lame::from_young_poisson(1e4, 0.3);
constexpr Damping damping{DampingModel::rotated, 30, 20};

/// Every third cell filtered above everything: its forces are those that it has anyway.
std::vector<SeparateCells> every_third(const DistributedMesh& mesh, std::size_t entry) {
  const auto& all = mesh.cells[entry];
  SeparateCells part{.entry = entry};
  std::vector<LocalIndex> nodes;
  LocalIndex interior = 0;
  for (LocalIndex cell = 0; cell < all.size(); cell += 3) {
    part.cells.push_back(cell);
    const auto of_cell = std::span(all.nodes).subspan(4 * static_cast<std::size_t>(cell), 4);
    nodes.insert(nodes.end(), of_cell.begin(), of_cell.end());
    interior += cell < all.interior ? 1 : 0;
  }
  const std::vector clamps(part.cells.size(), CellClamp{{1, 1, 1, 1}, 1e300});
  part.block = make_filtered_block({all.type, nodes, interior, 1000, {}}, mesh.rest_positions,
                                   NeoHookean{.lame = lame}, damping, clamps);
  std::vector<SeparateCells> parts;
  parts.push_back(std::move(part));
  return parts;
}

struct Answers {
  NodeField f, drag;
  double energy, stable, rate;
  LocalIndex inverted;
  std::vector<double> stretch;
};

Answers answers_of(const DistributedMesh& mesh, ElasticForces& elastic, NodeField& x, NodeField& v) {
  Answers a{NodeField(mesh), NodeField(mesh), 0, 0, 0, 0, {}};
  elastic.update(x, a.f);
  elastic.add_damping(v, a.drag, 1);
  a.energy = elastic.energy(x);
  a.stable = elastic.stable_step(x).undamped;
  a.rate = elastic.max_strain_rate(x, v);
  a.inverted = elastic.inverted_points(x);
  a.stretch.resize(static_cast<std::size_t>(mesh.cells[0].size()));
  elastic.min_stretch(x, 0, a.stretch);
  return a;
}

void expect_same(const Answers& a, const Answers& b) {
  for (std::size_t i = 0; i < a.f.owned().size(); ++i) {
    EXPECT_NEAR(a.f.owned()[i], b.f.owned()[i], 1e-9);
    EXPECT_NEAR(a.drag.owned()[i], b.drag.owned()[i], 1e-9);
  }
  EXPECT_NEAR(a.energy, b.energy, 1e-12 * a.energy);
  EXPECT_NEAR(a.rate, b.rate, 1e-9 * a.rate);
  EXPECT_EQ(a.inverted, b.inverted);
  ASSERT_EQ(a.stretch.size(), b.stretch.size());
  for (std::size_t c = 0; c < a.stretch.size(); ++c) EXPECT_NEAR(a.stretch[c], b.stretch[c], 1e-12);
}

TEST(SeparateCells, AreComputedAsIfTheyWereNot) {
  const auto mesh = distribute(PETSC_COMM_WORLD, generate_box({{1, 0.5, 0.5}}, {6, 3, 3}, BoxCells::tet6));
  ElasticForces elastic(mesh, std::vector{ElasticProperties{1000, NeoHookean{.lame = lame}, damping}});
  auto x = placed(mesh, [](const Vec3d& p) {
    return Vec3d{1.1 * p[0] + 0.3 * p[1] * p[1], p[1] * (1 - 2.5 * p[0]), p[2] + 0.2 * p[0]};
  });
  auto v = placed(mesh, [](const Vec3d& p) { return Vec3d{p[1], p[0] * p[2], -p[0]}; });
  const auto before = answers_of(mesh, elastic, x, v);
  GlobalIndex inverted = before.inverted;
  MPI_Allreduce(MPI_IN_PLACE, &inverted, 1, MPI_INT64_T, MPI_SUM, mesh.comm);
  ASSERT_GT(inverted, 0);

  elastic.separate(every_third(mesh, 0));
  EXPECT_EQ(elastic.blocks().size(), mesh.cells.size() + 1);
  const auto separate = answers_of(mesh, elastic, x, v);
  expect_same(before, separate);
  EXPECT_LE(separate.stable, before.stable * (1 + 1e-6)) << "stress counts for more in filtered cells";

  elastic.set_properties(0, {1000, NeoHookean{.lame = {2 * lame.lambda, 2 * lame.mu}}, damping});
  NodeField f(mesh);
  elastic.update(x, f);
  for (std::size_t i = 0; i < f.owned().size(); ++i) EXPECT_NEAR(f.owned()[i], 2 * before.f.owned()[i], 1e-9);
  elastic.set_properties(0, {1000, NeoHookean{.lame = lame}, damping});

  std::vector<SeparateCells> none;
  none.push_back({.entry = 0});
  elastic.separate(std::move(none));
  EXPECT_EQ(elastic.blocks().size(), mesh.cells.size());
  const auto back = answers_of(mesh, elastic, x, v);
  expect_same(before, back);
  EXPECT_NEAR(back.stable, before.stable, 1e-12 * before.stable);
}

TEST(SeparateCells, HaveTheirOwnLimitsAndEnergy) {
  const auto mesh = distribute(PETSC_COMM_WORLD, generate_box({{1, 0.5, 0.5}}, {6, 3, 3}, BoxCells::tet6));
  ElasticForces elastic(mesh, std::vector{ElasticProperties{1000, NeoHookean{.lame = lame}, damping}});
  auto x = at_rest(mesh);
  const auto findings = [&] {
    auto limits = element_limits(mesh, elastic, x);
    MassScaledStiffness stiffness(mesh, elastic);
    stiffness.assemble(x);
    return std::pair(std::move(limits), energy_shares(mesh, elastic, x, fastest_mode(stiffness, 1e-10)));
  };
  const auto [limits, energies] = findings();
  elastic.separate(every_third(mesh, 0));
  const auto [separate, energies_of_separate] = findings();
  ASSERT_EQ(separate.own_masses[0].size(), limits.own_masses[0].size());
  for (std::size_t c = 0; c < limits.own_masses[0].size(); ++c) {
    EXPECT_NEAR(separate.own_masses[0][c], limits.own_masses[0][c], 1e-9 * limits.own_masses[0][c]);
    EXPECT_NEAR(separate.nodal_masses[0][c], limits.nodal_masses[0][c], 1e-9 * limits.nodal_masses[0][c]);
    EXPECT_NEAR(energies_of_separate[0][c], energies[0][c], 1e-4);
  }
  EXPECT_NEAR(separate.largest_of_own, limits.largest_of_own, 1e-9 * limits.largest_of_own);
}

TEST(SeparateCells, MayBeAllOfAnEntry) {
  const auto mesh = distribute(PETSC_COMM_WORLD, generate_box({{1, 0.5, 0.5}}, {4, 2, 2}, BoxCells::tet6));
  FilteredBody body(mesh, 1000);
  const double limit = 2 / std::sqrt(body.largest_eigenvalue());
  const ModalFilter filter(mesh, body.elastic, at_step(2.5 * limit, FilterSelection::paper));
  ASSERT_EQ(body.over_ranks(filter.filtered_cells()), mesh.total_cells);
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) EXPECT_EQ(body.elastic.blocks()[e], nullptr);
  EXPECT_LE(body.largest_eigenvalue(), at_step(2.5 * limit, FilterSelection::paper).limit() * (1 + 1e-9));
  std::vector<double> stretch(static_cast<std::size_t>(mesh.cells[0].size()));
  body.elastic.min_stretch(at_rest(mesh), 0, stretch);
  for (const double s : stretch) EXPECT_NEAR(s, 1, 1e-12);
}

}  // namespace
}  // namespace evert::test
