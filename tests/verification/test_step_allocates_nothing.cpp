// A step takes no memory and assembles no matrix, whoever would do it: us, PETSc, MPI or the C++ library.
#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include <cstdlib>

// The allocations of the whole process: what the executable defines stands before the C library's.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

static long allocations = 0;
static bool counting = false;

void* malloc(std::size_t size) {
  if (counting) ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  if (counting) ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  if (counting) ++allocations;
  return __libc_realloc(memory, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  if (counting) ++allocations;
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? 12 : 0;  // ENOMEM
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  if (counting) ++allocations;
  return __libc_memalign(alignment, size);
}
}

namespace evert {
namespace {

/// Matrices emptied to be filled so far.
int assemblies_so_far() {
  PetscLogEvent event = 0;
  PetscEventPerfInfo info;
  check(PetscLogEventGetId("MatZeroEntries", &event));
  check(PetscLogEventGetPerfInfo(PETSC_DETERMINE, event, &info));
  return info.count;
}

struct Counts {
  long allocations;
  int assemblies;
  LocalIndex contacts;
  bool body_pushed;  // a body with a mass, by nodes
};

/// What ten steps of a body that slides on the ground take, once the first have made their lists.
Counts counts_of_steps(const std::vector<std::string>& options,
                       const std::vector<std::string>& overrides = {}) {
  for (const auto& option : options) check(PetscOptionsInsertString(nullptr, option.c_str()));
  auto scene = test::build(R"(
name: sliding block
end_time: 1
gravity: [2, -9.81, 0]
bodies:
  block:
    mesh: {generate: box, min: [0, 0, 0], max: [0.4, 0.2, 0.2], cells: [4, 2, 2], cell: tet6}
    transform: {translate: [0, -0.001, 0]}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1.0e5, poissons_ratio: 0.4}
    damping: {model: rotated, stiffness_proportional: 1.0e-3}
obstacles:
  ground: {shape: half_space, normal: [0, 1, 0], friction: 0.1}
)",
                           overrides);
  auto& simulation = *scene.simulation;
  if (simulation.filter()) {
    EXPECT_GT(simulation.filter()->filtered_cells(), 0);
  }
  const auto steps = [&](int count) {
    LocalIndex contacts = 0;
    for (int step = 0; step < count; ++step)
      contacts += simulation.step(simulation.suggested_time_step()).contacts;
    return contacts;
  };
  steps(5);
  // Of the last obstacle, which is the ball where there is one: it touches nothing but the block.
  const auto given = [&] {
    const auto impulses = simulation.obstacle_impulses();
    return impulses.empty() ? Vec3d{} : impulses.back().linear;
  };
  const auto given_before = given();
  const auto pushed = [&] { return norm(given() - given_before) > 0; };
  const int before = assemblies_so_far();
  allocations = 0;
  counting = true;
  const auto contacts = steps(10);
  counting = false;
  for (const auto& option : options)
    check(PetscOptionsClearValue(nullptr, option.substr(0, option.find(' ')).c_str()));
  return {allocations, assemblies_so_far() - before, contacts, pushed()};
}

TEST(Step, AllocatesAndAssemblesNothing) {
  check(PetscLogDefaultBegin());
  const auto counts = counts_of_steps({});
  EXPECT_GT(counts.contacts, 0) << "friction must have been at work";
  EXPECT_EQ(counts.allocations, 0);
  EXPECT_EQ(counts.assemblies, 0);
}

TEST(Step, AllocatesNothingWhileMuscleBecomesActive) {
  const auto counts =
      counts_of_steps({}, {"bodies.block.material={model: muscle, youngs_modulus: 1e5, poissons_ratio: 0.4}",
                           "bodies.block.fibres={direction: [1, 0, 0]}",
                           "bodies.block.activation=[[0, 0], [0.5, 0.5], [1, 0]]"});
  EXPECT_GT(counts.contacts, 0);
  EXPECT_EQ(counts.allocations, 0);
}

TEST(Step, AllocatesAndAssemblesNothingWithConsistentMasses) {
  check(PetscLogDefaultBegin());
  for (const char* damping :
       {"null", "{model: rotated, stiffness_proportional: 1.0e-3, mass_proportional: 2}"}) {
    const auto counts = counts_of_steps({}, {std::string("bodies.block.damping=") + damping, "obstacles=null",
                                             "integrator={mass: consistent}"});
    EXPECT_EQ(counts.allocations, 0) << damping;
    EXPECT_EQ(counts.assemblies, 0) << damping;
  }
}

TEST(Step, AllocatesNothingWhileARigidBodyRolls) {
  const auto counts = counts_of_steps(
      {}, {"obstacles={ground: {shape: half_space, normal: [0, 1, 0], friction: 0.1}, "
           "ball: {shape: sphere, center: [0.2, 0.298, 0.1], radius: 0.1, mass: 2, friction: 0.3}}"});
  EXPECT_TRUE(counts.body_pushed) << "the ball must press on the block";
  EXPECT_EQ(counts.allocations, 0);
}

TEST(Step, AllocatesNothingWithExplicitDamping) {
  for (const char* method : {"verlet", "symplectic_euler"})
    for (const char* damping : {"rotated", "blended"})
      EXPECT_EQ(counts_of_steps({}, {std::string("integrator.method=") + method,
                                     std::string("bodies.block.damping.model=") + damping})
                    .allocations,
                0)
          << method << ", " << damping;
}

TEST(Step, AllocatesNothingWithFilteredElements) {
  for (const char* filter : {"filter={time_step: 3e-3}", "filter={time_step: 3e-3, selection: adaptive}"})
    EXPECT_EQ(counts_of_steps({}, {filter}).allocations, 0) << filter;  // of all cells, and of a part
}

TEST(Step, IsSeenToAssembleWhereToldTo) {
  check(PetscLogDefaultBegin());
  EXPECT_GT(counts_of_steps({"-damping_mat_type baij"}).assemblies, 0);
}

}  // namespace
}  // namespace evert
