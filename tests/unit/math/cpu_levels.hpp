#pragma once
#include "level_kernels.hpp"
#include <span>

namespace evert::test {

/// The kernels of every CPU level that was compiled and that this machine runs, narrowest first. Says once on
/// stdout which levels it leaves out.
std::span<const LevelKernels* const> runnable_levels();

}  // namespace evert::test
