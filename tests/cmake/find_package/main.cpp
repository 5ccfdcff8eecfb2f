// Turns one tetrahedron inside out and asks the library for the energy [J] and for its sign.
#include "evert/forces/elastic_block.hpp"

#include <array>
#include <cstdio>
#include <vector>

int main() {
  const std::array<evert::LocalIndex, 4> nodes{0, 1, 2, 3};
  const evert::ElasticCells cells{.nodes = nodes, .interior = 1, .density = 1000};
  std::vector<evert::Vec3d> rest{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  evert::NeoHookean material;
  material.lame = evert::Lame::from_young_poisson(1e5, 0.3);
  const auto block = evert::make_elastic_block(cells, rest, material, {});

  std::vector<double> x{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1, 0};  // one double of slack
  const double energy = block->energy(x.data());
  std::printf("inverted points: %d, energy: %g J\n", static_cast<int>(block->inverted_points(x.data())),
              energy);
  return block->inverted_points(x.data()) == 1 && energy > 0 ? 0 : 1;
}
