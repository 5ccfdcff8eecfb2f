#pragma once
#include "evert/forces/kernels/elastic_kernels.hpp"

#include <string_view>

/// The instruction sets that the kernels are compiled for, from one source, and the choice among them at run
/// time.
namespace evert::kernels {

enum class CpuLevel {
  v2,  ///< SSE4.2, two doubles a register: what every binary of ours needs
  v3,  ///< AVX2 and FMA, four doubles
  v4,  ///< AVX-512, eight doubles
};

[[nodiscard]] std::string_view name_of(CpuLevel level);
[[nodiscard]] bool supports(CpuLevel level);

/// The best level of this CPU, or what the environment variable EVERT_CPU_LEVEL (v2, v3, v4) asks for. Throws
/// UserError when it asks for an unknown level or one that this CPU lacks.
[[nodiscard]] CpuLevel cpu_level();

/// The kernels of a kind of block at a level. Throws UserError for a cell type without a reference element.
[[nodiscard]] ElasticKernels find_kernels(CpuLevel level, CellType type, const Material& material,
                                          DampingModel damping);

// One per level, of the same source: src/forces/kernels/level.cpp.
namespace v2 {
ElasticKernels find(CellType type, const Material& material, DampingModel damping);
}
namespace v3 {
ElasticKernels find(CellType type, const Material& material, DampingModel damping);
}
namespace v4 {
ElasticKernels find(CellType type, const Material& material, DampingModel damping);
}

}  // namespace evert::kernels
