#include "evert/forces/kernels/kernel_table.hpp"

// As level.cpp, on packs of floats.
namespace evert::kernels::EVERT_KERNEL_LEVEL {

ElasticKernels find_mixed(CellType type, const Material& material, DampingModel damping) {
  return kernels_of<FloatPack>(AllReferenceElements{}, type, material, damping);
}

}  // namespace evert::kernels::EVERT_KERNEL_LEVEL
