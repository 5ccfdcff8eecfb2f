#include "evert/bench/level_kernels.hpp"

#include "general_path.hpp"

#define EVERT_NAME_OF(level) #level
#define EVERT_STRING(level) EVERT_NAME_OF(level)

// Compiled once per CPU level; what src/forces/kernels/level.cpp says of out-of-line copies holds here too.
namespace evert::bench::EVERT_KERNEL_LEVEL {
namespace {

/// Two units of four cycles want eight at least; sixteen registers hold twelve and the two factors.
constexpr std::size_t chains = 12;

/// Lets every chain go `steps` times to `next` of itself; their sum.
template <class Next>
EVERT_ALWAYS_INLINE double run_chains(std::size_t steps, Next&& next) {
  Pack x[chains];
  for (std::size_t i = 0; i < chains; ++i) x[i] = Pack(1.0 + 0.01 * static_cast<double>(i));
  for (std::size_t step = 0; step < steps; ++step) {
#pragma GCC unroll 12
    for (std::size_t i = 0; i < chains; ++i) x[i] = next(x[i]);
  }
  Pack all = x[0];
  for (std::size_t i = 1; i < chains; ++i) all += x[i];
  double sum = 0;
  for (std::size_t l = 0; l < lanes_v<Pack>; ++l) sum += lane(all, l);
  return sum;
}

double multiply_add(std::size_t steps) {
  return run_chains(
      steps, [factor = Pack(0.999999), addend = Pack(1e-6)](const Pack& x) { return x * factor + addend; });
}

double divide_and_root(std::size_t steps) {
  return run_chains(steps, [numerator = Pack(1.3)](const Pack& x) { return sqrt(numerator / x); });
}

void triad(double* a, const double* b, const double* c, double factor, std::size_t count) {
  const Pack factors = Pack(factor);
  for (std::size_t i = 0; i < count; i += lanes_v<Pack>)
    store(load<Pack>(b + i) + factors * load<Pack>(c + i), a + i);
}

}  // namespace

LevelKernels kernels() {
  return {EVERT_STRING(EVERT_KERNEL_LEVEL), multiply_add, 2.0 * chains * lanes_v<Pack>, divide_and_root,
          2.0 * chains * lanes_v<Pack>,     triad,        general_hex_kernels<Pack>()};
}

}  // namespace evert::bench::EVERT_KERNEL_LEVEL
