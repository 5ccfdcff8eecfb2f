#include "evert/elements/reference_element.hpp"
#include "evert/forces/elastic_block.hpp"
#include "evert/forces/kernels/cpu_level.hpp"

namespace evert {

std::unique_ptr<ElasticBlock> make_elastic_block(const ElasticCells& cells,
                                                 std::span<const Vec3d> rest_positions,
                                                 const Material& material, const Damping& damping) {
  with_reference_element(cells.type, [](const auto& /*exists*/) {});  // or throws, naming the types allowed
  const auto kernels = kernels::chosen_cpu_level().find(cells.type, material, damping.model);
  return make_elastic_block(cells, rest_positions, material, damping, kernels);
}

}  // namespace evert
