#include "cpu_levels.hpp"

#include <cstdio>
#include <vector>

namespace evert::test {

std::span<const LevelKernels* const> runnable_levels() {
  static const std::vector<const LevelKernels*> levels = [] {
    std::vector<const LevelKernels*> runnable;
#if defined(__x86_64__)
    const auto add = [&](const LevelKernels& kernels, int supported) {
      if (supported != 0) {
        runnable.push_back(&kernels);
      } else {
        std::printf("this CPU does not run x86-64-%s: its kernels are compiled but not tested\n",
                    kernels.name);
      }
    };
    add(v2::kernels(), __builtin_cpu_supports("x86-64-v2"));
    add(v3::kernels(), __builtin_cpu_supports("x86-64-v3"));
    add(v4::kernels(), __builtin_cpu_supports("x86-64-v4"));
#else
    runnable.push_back(&baseline::kernels());
#endif
    return runnable;
  }();
  return levels;
}

}  // namespace evert::test
