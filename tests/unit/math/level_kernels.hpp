#pragma once
#include "evert_cpu_levels.hpp"
#include <cstddef>

/// The functions under test, over plain arrays, compiled once per CPU level (see CMakeLists.txt). This header
/// and level_kernels.cpp include nothing whose inline functions the linker could share between levels: no
/// GoogleTest, no containers, no random numbers.
namespace evert::test {

/// Every operation of pack.hpp; see apply() in pack_operations.hpp.
enum class Operation {
  add,
  subtract,
  multiply,
  divide,
  negate,
  add_to,
  subtract_from,
  multiply_by,
  divide_by,
  less,
  greater,
  less_equal,
  greater_equal,
  equal,
  not_equal,
  square_root,
  absolute,
  minimum,
  maximum,
  copy_sign,
  times_sign,
  logarithm,
  exponential,
  power_of_two,
  broadcast,
  lane_sum_of_generated,
  count
};

/// Matrices are stored as structure of arrays: entry c (by columns) of matrix i at [c·count + i]. `count`
/// must be a multiple of 16, the widest pack.
struct Svd3Arrays {
  double* u;      ///< 9
  double* sigma;  ///< 3
  double* v;      ///< 9
};

struct IsotropicArrays {
  double* stretches;     ///< 3, in the order of principal_stretches
  double* tensor;        ///< 9, isotropic_tensor of the stretches: F again
  double* rotation;      ///< 9, polar_rotation
  double* disagreement;  ///< 1, largest entry of isotropic_tensor(p) − U diag(p) Vᵀ for one p
};

struct LevelKernels {
  const char* name;
  std::size_t double_lanes;
  std::size_t float_lanes;
  void (*operate)(Operation, const double* x, const double* y, double* result, std::size_t count);
  void (*operate_float)(Operation, const float* x, const float* y, float* result, std::size_t count);
  void (*svd3)(const double* f, Svd3Arrays result, std::size_t count);
  void (*isotropic)(const double* f, IsotropicArrays result, std::size_t count);
};

#define EVERT_DECLARE(level)     \
  namespace level {              \
  const LevelKernels& kernels(); \
  }
EVERT_FOR_CPU_LEVELS(EVERT_DECLARE)
#undef EVERT_DECLARE

}  // namespace evert::test
