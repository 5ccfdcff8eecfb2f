#include "evert/bench/level_kernels.hpp"

#include "evert/core/error.hpp"
#include "evert/forces/kernels/cpu_level.hpp"

#include "evert_cpu_levels.hpp"
#include <algorithm>
#include <iterator>
#include <string>

namespace evert::bench {

// One definition of kernels() per level, all of level.cpp.
#define EVERT_DECLARE(level) \
  namespace level {          \
  LevelKernels kernels();    \
  }
EVERT_FOR_CPU_LEVELS(EVERT_DECLARE)
#undef EVERT_DECLARE

const LevelKernels& level_kernels() {
#define EVERT_LEVEL(level) level::kernels(),
  static const LevelKernels all[] = {EVERT_FOR_CPU_LEVELS(EVERT_LEVEL)};
#undef EVERT_LEVEL
  const auto name = evert::kernels::chosen_cpu_level().name;
  const auto* const found = std::ranges::find(all, name, &LevelKernels::name);
  EVERT_ASSERT(found != std::end(all), std::string(name));
  return *found;
}

}  // namespace evert::bench
