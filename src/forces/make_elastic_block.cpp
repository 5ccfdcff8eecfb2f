#include "evert/elements/reference_element.hpp"
#include "evert/forces/elastic_block.hpp"
#include "evert/forces/kernels/cpu_level.hpp"

namespace evert {

std::unique_ptr<ElasticBlock> make_elastic_block(const ElasticCells& cells,
                                                 std::span<const Vec3d> rest_positions,
                                                 const Material& material, const Damping& damping,
                                                 Precision precision) {
  static_cast<void>(reference_element(cells.type));  // or throws, naming the types allowed
  const kernels::CpuLevel& level = kernels::chosen_cpu_level();
  const auto find = precision == Precision::mixed ? level.find_mixed : level.find;
  const auto kernels = find(cells.type, material, damping.model);
  return make_elastic_block(cells, rest_positions, material, damping, kernels);
}

}  // namespace evert
