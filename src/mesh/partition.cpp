#include "evert/mesh/partition.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"

#include <metis.h>

#include "dual_graph.hpp"
#include <algorithm>
#include <array>
#include <string>

namespace evert {
namespace {

constexpr idx_t seed = 4711;  // METIS's own default is "unspecified"

/// Partitioners may leave parts empty when cells are few: each takes the last cell of the then largest part.
void fill_empty_parts(std::vector<int>& part, int ranks) {
  std::vector<GlobalIndex> sizes(static_cast<std::size_t>(ranks));
  for (const int r : part) ++sizes[static_cast<std::size_t>(r)];
  for (int empty = 0; empty < ranks; ++empty) {
    if (sizes[static_cast<std::size_t>(empty)] > 0) continue;
    const auto largest = std::max_element(sizes.begin(), sizes.end());
    const auto cell = std::find(part.rbegin(), part.rend(), static_cast<int>(largest - sizes.begin()));
    *cell = empty;
    --*largest;
    ++sizes[static_cast<std::size_t>(empty)];
  }
}

std::string metis_message(int status) {
  switch (status) {
    case METIS_ERROR_MEMORY:
      return "METIS ran out of memory while partitioning the mesh";
    case METIS_ERROR_INPUT:
      return "METIS refused the mesh as input";
    default:
      return "METIS failed to partition the mesh";
  }
}

/// Throws UserError unless there is a cell for every rank.
void require_cells_for(const Mesh& mesh, int ranks) {
  const auto cells = mesh.cell_count();
  if (cells == 0) throw UserError("cannot distribute a mesh without cells");
  if (ranks > cells)
    throw UserError("cannot spread " + std::to_string(cells) + (cells == 1 ? " cell" : " cells") + " over " +
                    std::to_string(ranks) + " ranks: use at most " + std::to_string(cells));
}

}  // namespace

int quadrature_points(CellType type) {
  switch (type) {
    case CellType::tet4:
      return 1;
    case CellType::hex8:
      return 8;
    case CellType::wedge6:
      return 6;
    case CellType::tet10:
      return 4;
  }
  EVERT_ASSERT(false, "cell type " + std::to_string(static_cast<int>(type)));
  return 0;
}

std::vector<int> partition_cells(const Mesh& mesh, int ranks) {
  require_cells_for(mesh, ranks);
  const auto cells = static_cast<std::size_t>(mesh.cell_count());
  if (ranks == 1) return std::vector<int>(cells, 0);

  const DualGraph graph = dual_graph(mesh);
  auto weights = cell_weights<idx_t>(mesh);
  std::array<idx_t, METIS_NOPTIONS> options;
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = seed;
  auto vertices = static_cast<idx_t>(cells);
  idx_t constraints = 1;
  idx_t parts = ranks;
  idx_t cut = 0;
  std::vector<idx_t> part(cells);
  const int status = METIS_PartGraphKway(&vertices, &constraints, graph.offsets.get(), graph.neighbours.get(),
                                         weights.data(), nullptr, nullptr, &parts, nullptr, nullptr,
                                         options.data(), &cut, part.data());
  if (status != METIS_OK) throw UserError(metis_message(status));
  std::vector<int> result(part.begin(), part.end());
  fill_empty_parts(result, ranks);
  return result;
}

std::vector<int> partition_cells(MPI_Comm comm, const Mesh& mesh, Partitioner partitioner) {
  const int ranks = size_of(comm);
  on_root(comm, [&] { require_cells_for(mesh, ranks); });
  std::vector<int> part;
  if (partitioner == Partitioner::metis || ranks == 1) {
    on_root(comm, [&] { part = partition_cells(mesh, ranks); });
  } else {
    part = partition_by_ptscotch(comm, mesh);
    if (rank_of(comm) == 0) fill_empty_parts(part, ranks);
  }
  return part;
}

}  // namespace evert
