#include "evert/bench/level_kernels.hpp"

#include "evert/core/error.hpp"
#include "evert/forces/kernels/cpu_level.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace evert::bench {

// One definition of kernels() per level, all of level.cpp.
#if defined(__x86_64__)
namespace v2 {
LevelKernels kernels();
}
namespace v3 {
LevelKernels kernels();
}
namespace v4 {
LevelKernels kernels();
}
#else
namespace baseline {
LevelKernels kernels();
}
#endif

const LevelKernels& level_kernels() {
#if defined(__x86_64__)
  static const std::array all{v2::kernels(), v3::kernels(), v4::kernels()};
#else
  static const std::array all{baseline::kernels()};
#endif
  const auto name = evert::kernels::chosen_cpu_level().name;
  const auto* const found = std::ranges::find(all, name, &LevelKernels::name);
  EVERT_ASSERT(found != all.end(), std::string(name));
  return *found;
}

}  // namespace evert::bench
