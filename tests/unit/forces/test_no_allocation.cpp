#include <gtest/gtest.h>

#include "bodies.hpp"
#include <cstdlib>
#include <new>

// Counts every allocation of this binary.
namespace {
long allocations = 0;

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  const std::size_t rounded = (std::max<std::size_t>(size, 1) + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, rounded);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}

namespace evert::test {
namespace {

TEST(Allocation, NoneInAStep) {
  for (const CellType type : all_elements) {
    const Body body = box(type, 3, 3, 3);
    const NodalValues x = awkward_states(body)[2].x, v = random_velocities(body.rest.size());
    NodalValues f = zeros(body.rest.size());
    std::vector<double> normal(3 * body.rest.size()),
        shear = normal, stretch(static_cast<std::size_t>(body.cells())), dense(30 * 30);
    for (const Material& material : all_materials()) {
      for (const Damping& damping : {rotated_damping, objective_damping, blended_damping}) {
        const long before_making = allocations;
        const auto block = make_elastic_block(body.elastic_cells(5), body.rest, material, damping);
        ASSERT_GT(allocations, before_making) << "the counter counts";
        const long before = allocations;
        block->update(x.data(), f.data(), block->interior());
        block->update(x.data(), f.data(), block->boundary());
        block->add_damping(v.data(), f.data(), 1, block->interior());
        block->add_damping_diagonal(normal.data(), shear.data(), 1);
        block->damping_matrix(0, std::span(dense).first(9 * body.nodes_per_cell() * body.nodes_per_cell()));
        block->min_stretch(x.data(), stretch);
        const double sum = block->energy(x.data()) + block->stable_step(x.data()).damped +
                           block->max_strain_rate(x.data(), v.data()) + block->inverted_points(x.data());
        EXPECT_EQ(allocations, before) << name_of(material) << ", " << sum;
      }
    }
  }
}

}  // namespace
}  // namespace evert::test
