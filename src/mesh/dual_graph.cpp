#include "dual_graph.hpp"

#include "evert/core/error.hpp"

#include <limits>
#include <string>

namespace evert {
namespace {

/// Corners decide which cells share a face; the mid-edge nodes of tet10 would join cells that share an edge
/// only.
int corner_count(CellType type) { return type == CellType::tet10 ? 4 : node_count(type); }

void require_metis_can_count(const Mesh& mesh) {
  constexpr GlobalIndex most = std::numeric_limits<idx_t>::max();
  GlobalIndex entries = mesh.node_count();
  for (const auto& block : mesh.cells) entries += block.size() * corner_count(block.type);
  if (entries > most)
    throw UserError("the mesh is too large to partition: nodes and cell corners together are " +
                    std::to_string(entries) + ", and METIS was built to count to " + std::to_string(most));
}

}  // namespace

DualGraph dual_graph(const Mesh& mesh) {
  require_metis_can_count(mesh);
  std::vector<idx_t> offsets{0};
  std::vector<idx_t> corners;
  offsets.reserve(static_cast<std::size_t>(mesh.cell_count()) + 1);
  for (const auto& block : mesh.cells) {
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    const auto used = static_cast<std::size_t>(corner_count(block.type));
    for (std::size_t first = 0; first < block.nodes.size(); first += stride) {
      for (std::size_t i = 0; i < used; ++i) corners.push_back(static_cast<idx_t>(block.nodes[first + i]));
      offsets.push_back(static_cast<idx_t>(corners.size()));
    }
  }
  auto cells = static_cast<idx_t>(mesh.cell_count());
  auto nodes = static_cast<idx_t>(mesh.node_count());
  idx_t nodes_of_a_face = 3;  // two hexahedra or wedges that share three corners share the whole face
  idx_t numbering = 0;
  idx_t* xadj = nullptr;
  idx_t* adjncy = nullptr;
  const int status = METIS_MeshToDual(&cells, &nodes, offsets.data(), corners.data(), &nodes_of_a_face,
                                      &numbering, &xadj, &adjncy);
  if (status != METIS_OK) throw UserError("METIS failed to build the graph of the mesh's cells");
  DualGraph graph;
  graph.offsets.reset(xadj);
  graph.neighbours.reset(adjncy);
  return graph;
}

}  // namespace evert
