#include "evert/forces/kernels/kernel_table.hpp"

// Compiled once per CPU level, each time with another -march and EVERT_KERNEL_LEVEL, which makes Pack another
// type. Nothing here may leave an out-of-line copy of a function that other sources define too: the linker
// keeps one, perhaps the one this CPU cannot run. The test kernel_symbols looks.
namespace evert::kernels::EVERT_KERNEL_LEVEL {

ElasticKernels find(CellType type, const Material& material, DampingModel damping) {
  return kernels_of<Pack>(AllReferenceElements{}, type, material, damping);
}

}  // namespace evert::kernels::EVERT_KERNEL_LEVEL
