#include "evert/math/svd3_batch.hpp"

#include "evert/math/cpu_support.hpp"

#include <cassert>
#include <cstdlib>

namespace evert {

// One definition per CPU level, all of svd3_level.cpp.
namespace detail {
#if defined(__x86_64__)
namespace v2 {
void svd3_batch(const Mat3d* f, std::size_t count, Svd3<double>* svd);
}
namespace v3 {
void svd3_batch(const Mat3d* f, std::size_t count, Svd3<double>* svd);
}
namespace v4 {
void svd3_batch(const Mat3d* f, std::size_t count, Svd3<double>* svd);
}
#else
namespace baseline {
void svd3_batch(const Mat3d* f, std::size_t count, Svd3<double>* svd);
}
#endif
}  // namespace detail

std::span<const Svd3BatchLevel> svd3_batch_levels() {
#if defined(__x86_64__)
  static const Svd3BatchLevel levels[] = {{"v2", true, detail::v2::svd3_batch},
                                          {"v3", cpu_supports("v3"), detail::v3::svd3_batch},
                                          {"v4", cpu_supports("v4"), detail::v4::svd3_batch}};
#else
  static const Svd3BatchLevel levels[] = {{"baseline", true, detail::baseline::svd3_batch}};
#endif
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
  return *widest;
}

}  // namespace

void svd3_batch(std::span<const Mat3d> f, std::span<Svd3<double>> svd) {
  assert(svd.size() == f.size());
  static const Svd3BatchLevel& level = chosen_level();
  level.run(f.data(), f.size(), svd.data());
}

}  // namespace evert
