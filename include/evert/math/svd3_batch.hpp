#pragma once
#include "evert/math/svd3.hpp"

#include <cstddef>
#include <span>
#include <string_view>

/// The SVD of many matrices at once, for library users who have them as an array of structures.
namespace evert {

/// svd[i] = SVD of f[i], with the guarantees of svd3 (every F, errors below 1e-14), at several times the rate
/// of svd3 one by one. Runs the widest instruction set that this CPU has, or the one that the environment
/// variable EVERT_CPU_LEVEL names, when it has that; results of different ones differ by rounding. `svd` has
/// the size of `f` and does not overlap it. Allocates nothing, throws nothing, may be called by many threads.
void svd3_batch(std::span<const Mat3d> f, std::span<Svd3<double>> svd);

/// The same for one instruction set. docs/design/cpu-levels.md
struct Svd3BatchLevel {
  std::string_view name;  ///< v2, v3, v4; elsewhere than on x86-64 only baseline
  bool supported;         ///< this CPU runs it
  void (*run)(const Mat3d* f, std::size_t count, Svd3<double>* svd);
};

/// Those compiled in, narrowest first.
[[nodiscard]] std::span<const Svd3BatchLevel> svd3_batch_levels();

}  // namespace evert
