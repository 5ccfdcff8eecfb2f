#pragma once
#include "evert/forces/kernels/elastic_kernels.hpp"

#include <span>
#include <string_view>

/// The instruction sets that the kernels are compiled for, from one source, and the choice among them at run
/// time. docs/design/cpu-levels.md
namespace evert::kernels {

struct CpuLevel {
  std::string_view name;  ///< v2 (SSE4.2, two doubles a register), v3 (AVX2, four), v4 (AVX-512, eight);
                          ///< elsewhere than on x86-64 only baseline
  bool supported;         ///< this CPU runs it
  /// The kernels of a kind of block; `lanes` is 0 in the answer for a cell type without a reference element.
  ElasticKernels (*find)(CellType type, const Material& material, DampingModel damping);
  /// The same in mixed precision: twice as many cells to a batch.
  ElasticKernels (*find_mixed)(CellType type, const Material& material, DampingModel damping);
};

/// Those compiled in (EVERT_CPU_LEVELS of the build), narrowest first.
[[nodiscard]] std::span<const CpuLevel> cpu_levels();

/// The widest that this CPU supports, or what the environment variable EVERT_CPU_LEVEL names. Throws
/// UserError when that is an unknown level or one that this CPU lacks, or when it runs none.
[[nodiscard]] const CpuLevel& chosen_cpu_level();

}  // namespace evert::kernels
