#include "filtered_kernels.hpp"

#include "evert/core/error.hpp"
#include "evert/forces/kernels/cpu_level.hpp"

#include "evert_cpu_levels.hpp"
#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>

namespace evert::filtered {

// One definition of find() per level, all of filtered_level.cpp.
#define EVERT_DECLARE(level)              \
  namespace level {                       \
  Kernels find(const Material& material); \
  }
EVERT_FOR_CPU_LEVELS(EVERT_DECLARE)
#undef EVERT_DECLARE

namespace {

struct Level {
  std::string_view name;
  Kernels (*find)(const Material& material);
};

}  // namespace

Kernels kernels_for(const Material& material) {
#define EVERT_LEVEL(level) Level{#level, level::find},
  static constexpr Level levels[] = {EVERT_FOR_CPU_LEVELS(EVERT_LEVEL)};
#undef EVERT_LEVEL
  const auto name = kernels::chosen_cpu_level().name;
  const auto* const level = std::ranges::find(levels, name, &Level::name);
  EVERT_ASSERT(level != std::end(levels), std::string(name));
  const Kernels found = level->find(material);
  EVERT_ASSERT(found.lanes > 0, "a model with fibres");
  return found;
}

}  // namespace evert::filtered
