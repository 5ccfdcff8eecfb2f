#pragma once
#include "evert/forces/kernels/elastic_kernels.hpp"
#include "evert/math/pack.hpp"

#include <cstddef>
#include <string_view>

/// Loops that are compiled once per CPU level, as the kernels of `forces` are.  docs/design/cpu-levels.md
namespace evert::bench {

struct LevelKernels {
  std::string_view name;  ///< of the CPU level
  /// `steps` times as many independent multiplications and additions as keep all units busy, fused where the
  /// level can; the answer depends on all of them.
  double (*multiply_add)(std::size_t steps);
  double flops_per_step;
  /// The same of divisions and square roots, as many of each: they share one unit.
  double (*divide_and_root)(std::size_t steps);
  double divisions_per_step;  ///< and square roots
  /// a = b + factor · c for `count` numbers, a multiple of 8.
  void (*triad)(double* a, const double* b, const double* c, double factor, std::size_t count);
  /// Forces of hex8 by U and V and by shape gradients, for a block of neo-Hookean cells.
  evert::kernels::ElasticKernels general_hex;
};

/// Those of kernels::chosen_cpu_level(), and as that it throws UserError.
[[nodiscard]] const LevelKernels& level_kernels();

}  // namespace evert::bench
