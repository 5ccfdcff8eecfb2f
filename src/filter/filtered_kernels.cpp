#include "filtered_kernels.hpp"

#include "evert/core/error.hpp"
#include "evert/forces/kernels/cpu_level.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace evert::filtered {

// One definition of find() per level, all of filtered_level.cpp.
#if defined(__x86_64__)
namespace v2 {
Kernels find(const Material& material);
}
namespace v3 {
Kernels find(const Material& material);
}
namespace v4 {
Kernels find(const Material& material);
}
#else
namespace baseline {
Kernels find(const Material& material);
}
#endif

namespace {

struct Level {
  std::string_view name;
  Kernels (*find)(const Material& material);
};

}  // namespace

Kernels kernels_for(const Material& material) {
#if defined(__x86_64__)
  static constexpr std::array levels{Level{"v2", v2::find}, Level{"v3", v3::find}, Level{"v4", v4::find}};
#else
  static constexpr std::array levels{Level{"baseline", baseline::find}};
#endif
  const auto name = kernels::chosen_cpu_level().name;
  const auto* const level = std::ranges::find(levels, name, &Level::name);
  EVERT_ASSERT(level != levels.end(), std::string(name));
  const Kernels found = level->find(material);
  EVERT_ASSERT(found.lanes > 0, "a model with fibres");
  return found;
}

}  // namespace evert::filtered
