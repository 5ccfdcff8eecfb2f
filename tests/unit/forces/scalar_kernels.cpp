#include "evert/forces/kernels/kernel_table.hpp"

#include "bodies.hpp"

/// Compiled once for all tests: all kernels of all elements and models.
namespace evert::test {

kernels::ElasticKernels scalar_kernels(CellType type, const Material& material, DampingModel damping) {
  return kernels::kernels_of<double>(AllReferenceElements{}, type, material, damping);
}

}  // namespace evert::test
