#include "evert/forces/kernels/cpu_level.hpp"

#include "evert/core/error.hpp"
#include "evert/elements/reference_element.hpp"

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

namespace evert::kernels {
namespace {

constexpr std::array all_levels{CpuLevel::v2, CpuLevel::v3, CpuLevel::v4};

CpuLevel best_level() {
  CpuLevel best = CpuLevel::v2;
  for (const CpuLevel level : all_levels) {
    if (supports(level)) best = level;
  }
  return best;
}

CpuLevel level_named(const std::string& name) {
  std::vector<std::string> allowed;
  for (const CpuLevel level : all_levels) {
    if (!supports(level)) continue;
    if (name == name_of(level)) return level;
    allowed.emplace_back(name_of(level));
  }
  std::string message = "the environment variable EVERT_CPU_LEVEL is '";
  message += name;
  message += "'; allowed on this CPU are ";
  message += list_of(allowed);
  throw UserError(message);
}

}  // namespace

std::string_view name_of(CpuLevel level) {
  switch (level) {
    case CpuLevel::v2:
      return "v2";
    case CpuLevel::v3:
      return "v3";
    case CpuLevel::v4:
      return "v4";
  }
  return "";
}

bool supports(CpuLevel level) {
  switch (level) {
    case CpuLevel::v2:
      return true;
    case CpuLevel::v3:
      return __builtin_cpu_supports("x86-64-v3") != 0;
    case CpuLevel::v4:
      return __builtin_cpu_supports("x86-64-v4") != 0;
  }
  return false;
}

CpuLevel cpu_level() {
  const char* asked_for = std::getenv("EVERT_CPU_LEVEL");
  return asked_for == nullptr ? best_level() : level_named(asked_for);
}

ElasticKernels find_kernels(CpuLevel level, CellType type, const Material& material, DampingModel damping) {
  // Reports a type without an element, with the allowed ones.
  with_reference_element(type, [](const auto& /*element*/) {});
  switch (level) {
    case CpuLevel::v2:
      break;
    case CpuLevel::v3:
      return v3::find(type, material, damping);
    case CpuLevel::v4:
      return v4::find(type, material, damping);
  }
  return v2::find(type, material, damping);
}

}  // namespace evert::kernels
