#pragma once
#include <string_view>

namespace evert {

/// Whether this CPU runs code compiled for x86-64-`level`, level being v2, v3 or v4; for `baseline`, the one
/// level elsewhere than on x86-64, always.
/// docs/design/cpu-levels.md
[[nodiscard]] inline bool cpu_supports([[maybe_unused]] std::string_view level) {
#if defined(__x86_64__)
  if (level == "v2") return __builtin_cpu_supports("x86-64-v2") != 0;
  if (level == "v3") return __builtin_cpu_supports("x86-64-v3") != 0;
  if (level == "v4") return __builtin_cpu_supports("x86-64-v4") != 0;
#endif
  return level == "baseline";
}

}  // namespace evert
