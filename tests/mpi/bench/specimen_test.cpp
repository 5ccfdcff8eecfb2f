#include "evert/bench/specimen.hpp"

#include "evert/forces/elastic_block.hpp"
#include "evert/math/nodal.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace evert::bench {
namespace {

struct NodeState {
  Vec3d rest, position, velocity;
  bool operator==(const NodeState&) const = default;
};

/// Of this rank's nodes, ghosts included, by their number in the undistributed mesh.
std::map<GlobalIndex, NodeState> states_of(const Specimen& specimen) {
  std::map<GlobalIndex, NodeState> states;
  for (LocalIndex node = 0; node < specimen.mesh.local_nodes(); ++node) {
    const auto i = static_cast<std::size_t>(node);
    states[specimen.mesh.original_nodes[i]] = {specimen.mesh.rest_positions[i],
                                               node_value(specimen.positions.local(), node),
                                               node_value(specimen.velocities.local(), node)};
  }
  return states;
}

TEST(Specimen, IsTheSameOnAnyNumberOfRanks) {
  for (const auto type : {CellType::tet4, CellType::hex8}) {
    const Specimen whole(MPI_COMM_SELF, type, 4);
    const Specimen distributed(MPI_COMM_WORLD, type, 4);
    const auto expected = states_of(whole);
    for (const auto& [node, state] : states_of(distributed))
      EXPECT_EQ(state, expected.at(node)) << name_of(type) << " node " << node;
  }
}

TEST(Specimen, HasAboutATwelfthOfTheTetrahedraInverted) {
  const Specimen specimen(MPI_COMM_SELF, CellType::tet4, 12);
  const auto& cells = specimen.mesh.cells.front();
  const auto block = make_elastic_block({cells.type, cells.nodes, cells.interior, 1},
                                        specimen.mesh.rest_positions, NeoHookean{.lame = {1, 1}}, {});
  const double inverted = block->inverted_points(specimen.positions.local().data());
  EXPECT_NEAR(inverted / cells.size(), 1.0 / 12, 0.01);  // scatter of 10,368 tetrahedra: 0.003
}

}  // namespace
}  // namespace evert::bench
