#include "cpu_levels.hpp"

#include "evert/math/cpu_support.hpp"

#include <cstdio>
#include <vector>

namespace evert::test {

std::span<const LevelKernels* const> runnable_levels() {
  static const std::vector<const LevelKernels*> levels = [] {
    std::vector<const LevelKernels*> runnable;
    const auto add = [&](const LevelKernels& kernels) {
      if (cpu_supports(kernels.name)) {
        runnable.push_back(&kernels);
      } else {
        std::printf("this CPU does not run x86-64-%s: its kernels are compiled but not tested\n",
                    kernels.name);
      }
    };
#define EVERT_ADD(level) add(level::kernels());
    EVERT_FOR_CPU_LEVELS(EVERT_ADD)
#undef EVERT_ADD
    return runnable;
  }();
  return levels;
}

}  // namespace evert::test
