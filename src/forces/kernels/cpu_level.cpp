#include "evert/forces/kernels/cpu_level.hpp"

#include "evert/core/error.hpp"
#include "evert/math/cpu_support.hpp"

#include "evert_cpu_levels.hpp"
#include <cstdlib>
#include <string>
#include <vector>

namespace evert::kernels {

// One definition each per level, all of level.cpp and level_mixed.cpp.
#define EVERT_DECLARE(level)                                                                \
  namespace level {                                                                         \
  ElasticKernels find(CellType type, const Material& material, DampingModel damping);       \
  ElasticKernels find_mixed(CellType type, const Material& material, DampingModel damping); \
  }
EVERT_FOR_CPU_LEVELS(EVERT_DECLARE)
#undef EVERT_DECLARE

std::span<const CpuLevel> cpu_levels() {
#define EVERT_LEVEL(level) CpuLevel{#level, cpu_supports(#level), level::find, level::find_mixed},
  static const CpuLevel levels[] = {EVERT_FOR_CPU_LEVELS(EVERT_LEVEL)};
#undef EVERT_LEVEL
  return levels;
}

const CpuLevel& chosen_cpu_level() {
  const char* asked_for = std::getenv("EVERT_CPU_LEVEL");
  const CpuLevel* widest = nullptr;
  std::vector<std::string> allowed;
  for (const CpuLevel& level : cpu_levels()) {
    if (!level.supported) continue;
    if (asked_for != nullptr && asked_for == level.name) return level;
    widest = &level;
    allowed.emplace_back(level.name);
  }
  if (widest == nullptr)
    throw UserError("this program was built for wider registers than this CPU has (EVERT_CPU_LEVELS)");
  if (asked_for == nullptr) return *widest;
  std::string message = "the environment variable EVERT_CPU_LEVEL is '";
  message += asked_for;
  message += "'; allowed on this CPU are ";
  message += list_of(allowed);
  throw UserError(message);
}

}  // namespace evert::kernels
