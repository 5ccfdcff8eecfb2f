#include "evert/core/collective.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <gtest/gtest.h>

#include "test_meshes.hpp"
#include <cstdint>
#include <cstring>
#include <numeric>
#include <random>

namespace evert {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

DistributedMesh some_mesh() { return distribute(world, test::tet_cube(5)); }

/// A value that tells node and component.
double signature(GlobalIndex node, std::size_t component) {
  return static_cast<double>(node) + 0.25 * static_cast<double>(component);
}

TEST(NodeField, IsAlignedZeroAndHasSlack) {
  const auto mesh = some_mesh();
  NodeField field(mesh);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(field.local().data()) % 64, 0U);
  EXPECT_EQ(field.local().size(), 3 * static_cast<std::size_t>(mesh.local_nodes()));
  EXPECT_EQ(field.owned().size(), 3 * static_cast<std::size_t>(mesh.owned_nodes));
  for (const auto value : field.local()) EXPECT_EQ(value, 0.0);
}

TEST(NodeField, IsThePetscVector) {
  const auto mesh = some_mesh();
  NodeField field(mesh);
  PetscInt size = 0;
  PetscInt block = 0;
  check(VecGetSize(field.vec(), &size));
  check(VecGetBlockSize(field.vec(), &block));
  EXPECT_EQ(size, 3 * mesh.total_nodes);
  EXPECT_EQ(block, 3);
  check(VecSet(field.vec(), 2.0));
  for (const auto value : field.owned()) EXPECT_EQ(value, 2.0);
  double norm = 0;
  check(VecNorm(field.vec(), NORM_INFINITY, &norm));
  for (auto& value : field.owned()) value = 5.0;
  field.touched();
  check(VecNorm(field.vec(), NORM_INFINITY, &norm));
  EXPECT_EQ(norm, 5.0);
}

TEST(NodeField, KeepsItsArrayWhenMoved) {
  const auto mesh = some_mesh();
  NodeField first(mesh);
  NodeField field(std::move(first));
  check(VecSet(field.vec(), 3.0));
  for (const auto value : field.owned()) EXPECT_EQ(value, 3.0);
  NodeField other(mesh);
  other = std::move(field);
  check(VecSet(other.vec(), 4.0));
  for (const auto value : other.owned()) EXPECT_EQ(value, 4.0);
}

TEST(Halo, UpdateCopiesOwnersValuesToGhosts) {
  const auto mesh = some_mesh();
  const Halo halo(mesh);
  NodeField field(mesh);
  for (std::size_t i = 0; i < field.owned().size(); ++i)
    field.owned()[i] = signature(mesh.original_nodes[i / 3], i % 3);
  field.touched();
  halo.begin_update(field);
  halo.end_update(field);
  for (std::size_t i = 0; i < field.local().size(); ++i)
    EXPECT_EQ(field.local()[i], signature(mesh.original_nodes[i / 3], i % 3));
}

TEST(Halo, AddSumsEveryCopyAtItsOwner) {
  const auto mesh = some_mesh();
  const Halo halo(mesh);
  NodeField field(mesh);
  // Cells around each node, counted locally and added up, against the whole mesh.
  for (const auto& cells : mesh.cells)
    for (const auto node : cells.nodes)
      for (std::size_t c = 0; c < 3; ++c)
        field.local()[3 * static_cast<std::size_t>(node) + c] += double(c + 1);
  field.touched();
  const std::vector<double> before(field.local().begin(), field.local().end());
  halo.begin_add(field);
  halo.end_add(field);

  const auto whole = test::tet_cube(5);
  std::vector<double> around(whole.nodes.size());
  for (const auto node : whole.cells.front().nodes) around[static_cast<std::size_t>(node)] += 1;
  for (std::size_t i = 0; i < field.owned().size(); ++i)
    EXPECT_EQ(field.owned()[i],
              double(i % 3 + 1) * around[static_cast<std::size_t>(mesh.original_nodes[i / 3])]);
  for (std::size_t i = field.owned().size(); i < before.size(); ++i) EXPECT_EQ(field.local()[i], before[i]);
}

TEST(Halo, AddIsRepeatableBitByBit) {
  const auto mesh = some_mesh();
  const Halo halo(mesh);
  std::mt19937_64 random(static_cast<std::uint64_t>(7 + rank_of(world)));
  std::uniform_real_distribution<double> values(-1, 1);
  std::vector<double> start(3 * static_cast<std::size_t>(mesh.local_nodes()));
  for (auto& value : start) value = values(random);
  std::vector<double> reference;
  for (int repeat = 0; repeat < 50; ++repeat) {
    NodeField field(mesh);
    std::copy(start.begin(), start.end(), field.local().begin());
    field.touched();
    halo.begin_add(field);
    halo.end_add(field);
    const std::vector<double> result(field.owned().begin(), field.owned().end());
    if (repeat == 0) reference = result;
    ASSERT_EQ(std::memcmp(result.data(), reference.data(), result.size() * sizeof(double)), 0);
  }
}

TEST(Halo, TwoFieldsMayTravelAtOnce) {
  const auto mesh = some_mesh();
  const Halo halo(mesh);
  NodeField a(mesh);
  NodeField b(mesh);
  check(VecSet(a.vec(), 1.0));
  check(VecSet(b.vec(), 2.0));
  halo.begin_update(a);
  halo.begin_update(b);
  halo.end_update(b);
  halo.end_update(a);
  for (const auto value : a.local()) EXPECT_EQ(value, 1.0);
  for (const auto value : b.local()) EXPECT_EQ(value, 2.0);
}

TEST(Halo, WorksWithoutGhosts) {
  const auto mesh = distribute(MPI_COMM_SELF, test::single_tet());
  const Halo halo(mesh);
  NodeField field(mesh);
  check(VecSet(field.vec(), 1.5));
  halo.begin_update(field);
  halo.end_update(field);
  halo.begin_add(field);
  halo.end_add(field);
  for (const auto value : field.local()) EXPECT_EQ(value, 1.5);
}

}  // namespace
}  // namespace evert
