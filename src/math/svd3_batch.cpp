#include "evert/math/svd3_batch.hpp"

#include "evert/math/cpu_support.hpp"

#include "evert_cpu_levels.hpp"
#include <cassert>
#include <cstdlib>
#include <stdexcept>

namespace evert {

// One definition per CPU level, all of svd3_level.cpp.
namespace detail {
#define EVERT_DECLARE(level)                                             \
  namespace level {                                                      \
  void svd3_batch(const Mat3d* f, std::size_t count, Svd3<double>* svd); \
  }
EVERT_FOR_CPU_LEVELS(EVERT_DECLARE)
#undef EVERT_DECLARE
}  // namespace detail

std::span<const Svd3BatchLevel> svd3_batch_levels() {
#define EVERT_LEVEL(level) Svd3BatchLevel{#level, cpu_supports(#level), detail::level::svd3_batch},
  static const Svd3BatchLevel levels[] = {EVERT_FOR_CPU_LEVELS(EVERT_LEVEL)};
#undef EVERT_LEVEL
  return levels;
}

namespace {

const Svd3BatchLevel& chosen_level() {
  const char* asked_for = std::getenv("EVERT_CPU_LEVEL");
  const Svd3BatchLevel* widest = nullptr;
  for (const Svd3BatchLevel& level : svd3_batch_levels()) {
    if (!level.supported) continue;
    widest = &level;
    if (asked_for != nullptr && asked_for == level.name) break;
  }
  if (widest == nullptr)
    throw std::runtime_error("svd3_batch was built for wider registers than this CPU has");
  return *widest;
}

}  // namespace

void svd3_batch(std::span<const Mat3d> f, std::span<Svd3<double>> svd) {
  assert(svd.size() == f.size());
  static const Svd3BatchLevel& level = chosen_level();
  level.run(f.data(), f.size(), svd.data());
}

}  // namespace evert
