#include "evert/forces/elastic_block.hpp"
#include "evert/forces/kernels/cpu_level.hpp"

namespace evert {

std::unique_ptr<ElasticBlock> make_elastic_block(const ElasticCells& cells,
                                                 std::span<const Vec3d> rest_positions,
                                                 const Material& material, const Damping& damping) {
  const auto kernels = kernels::find_kernels(kernels::cpu_level(), cells.type, material, damping.model);
  return make_elastic_block(cells, rest_positions, material, damping, kernels);
}

}  // namespace evert
