#include "evert/forces/kernels/cpu_level.hpp"

#include "evert/core/error.hpp"
#include "evert/math/cpu_support.hpp"

#include <cstdlib>
#include <string>
#include <vector>

namespace evert::kernels {

// One definition each per level, all of level.cpp and level_mixed.cpp.
#if defined(__x86_64__)
namespace v2 {
ElasticKernels find(CellType type, const Material& material, DampingModel damping);
ElasticKernels find_mixed(CellType type, const Material& material, DampingModel damping);
}  // namespace v2
namespace v3 {
ElasticKernels find(CellType type, const Material& material, DampingModel damping);
ElasticKernels find_mixed(CellType type, const Material& material, DampingModel damping);
}  // namespace v3
namespace v4 {
ElasticKernels find(CellType type, const Material& material, DampingModel damping);
ElasticKernels find_mixed(CellType type, const Material& material, DampingModel damping);
}  // namespace v4
#else
namespace baseline {
ElasticKernels find(CellType type, const Material& material, DampingModel damping);
ElasticKernels find_mixed(CellType type, const Material& material, DampingModel damping);
}  // namespace baseline
#endif

std::span<const CpuLevel> cpu_levels() {
#if defined(__x86_64__)
  static const CpuLevel levels[] = {{"v2", true, v2::find, v2::find_mixed},
                                    {"v3", cpu_supports("v3"), v3::find, v3::find_mixed},
                                    {"v4", cpu_supports("v4"), v4::find, v4::find_mixed}};
#else
  static const CpuLevel levels[] = {{"baseline", true, baseline::find, baseline::find_mixed}};
#endif
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
  if (asked_for == nullptr) return *widest;
  std::string message = "the environment variable EVERT_CPU_LEVEL is '";
  message += asked_for;
  message += "'; allowed on this CPU are ";
  message += list_of(allowed);
  throw UserError(message);
}

}  // namespace evert::kernels
