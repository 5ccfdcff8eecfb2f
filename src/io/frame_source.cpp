#include "evert/io/frame_writer.hpp"
#include "evert/sim/simulation.hpp"

namespace evert {

FrameSource frame_source(const Simulation& simulation) {
  return {simulation.time(),
          simulation.steps(),
          simulation.positions(),
          simulation.velocities(),
          [&simulation](std::size_t block, std::span<double> per_cell) {
            simulation.min_stretch(block, per_cell);
          },
          [&simulation](std::size_t block, std::span<double> per_cell) {
            simulation.elastic().equivalent_plastic_strain(block, per_cell);
          },
          [&simulation](std::size_t block, std::span<double> per_cell) {
            simulation.elastic().plastic_volume_ratio(block, per_cell);
          }};
}

}  // namespace evert
