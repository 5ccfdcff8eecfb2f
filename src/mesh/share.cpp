#include "share.hpp"

#include "evert/core/collective.hpp"

#include <petscsys.h>

#include "transfer.hpp"
#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace evert {
namespace {

constexpr int no_rank = -1;

/// Lowest and highest rank among the cells around a node.
struct RankRange {
  int lowest = std::numeric_limits<int>::max();
  int highest = no_rank;

  void include(int rank) {
    lowest = std::min(lowest, rank);
    highest = std::max(highest, rank);
  }
  /// The rule of distribute(); no_rank for a node of no cell.
  [[nodiscard]] int owner() const {
    return highest == no_rank || (lowest + highest) % 2 == 0 ? highest : lowest;
  }
};

/// Cuts rank 0's mesh into shares, one rank after the other.
class Dealer {
 public:
  Dealer(const Outline& outline, const Mesh& mesh, const std::vector<int>& part, int ranks);
  [[nodiscard]] Share share_of(int rank);

 private:
  void find_owners(const std::vector<int>& part);
  void sort_cells_by_rank(const std::vector<int>& part, int ranks);
  template <class Visit>
  void for_each_cell_of(int rank, Visit&& visit) const;
  [[nodiscard]] std::vector<GlobalIndex> nodes_of(int rank);

  const Outline& outline_;
  const Mesh& mesh_;
  std::vector<int> owner_;            // per node
  std::vector<GlobalIndex> natural_;  // per node
  std::vector<LocalIndex> slot_;      // per node: its number in the share being made, −1 elsewhere
  std::vector<GlobalIndex> by_rank_;  // cells sorted by rank
  std::vector<std::size_t> first_;    // per rank: where its cells begin in by_rank_
};

Dealer::Dealer(const Outline& outline, const Mesh& mesh, const std::vector<int>& part, int ranks)
    : outline_(outline), mesh_(mesh), slot_(mesh.nodes.size(), -1) {
  find_owners(part);
  sort_cells_by_rank(part, ranks);
  natural_.reserve(mesh.nodes.size());
  GlobalIndex used = 0;
  for (const int owner : owner_) natural_.push_back(owner == no_rank ? used : used++);
}

void Dealer::find_owners(const std::vector<int>& part) {
  std::vector<RankRange> touching(mesh_.nodes.size());
  auto rank = part.begin();
  for (const auto& block : mesh_.cells) {
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    for (std::size_t first = 0; first < block.nodes.size(); first += stride, ++rank)
      for (std::size_t i = first; i < first + stride; ++i)
        touching[static_cast<std::size_t>(block.nodes[i])].include(*rank);
  }
  owner_.resize(touching.size());
  std::transform(touching.begin(), touching.end(), owner_.begin(),
                 [](const RankRange& r) { return r.owner(); });
}

void Dealer::sort_cells_by_rank(const std::vector<int>& part, int ranks) {
  first_.assign(static_cast<std::size_t>(ranks) + 1, 0);
  for (const int rank : part) ++first_[static_cast<std::size_t>(rank) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  by_rank_.resize(part.size());
  auto next = first_;
  for (std::size_t cell = 0; cell < part.size(); ++cell)
    by_rank_[next[static_cast<std::size_t>(part[cell])]++] = static_cast<GlobalIndex>(cell);
}

/// visit(block, its nodes, number in the block, number in the whole mesh)
template <class Visit>
void Dealer::for_each_cell_of(int rank, Visit&& visit) const {
  auto block = mesh_.cells.begin();
  GlobalIndex first_of_block = 0;
  for (std::size_t i = first_[static_cast<std::size_t>(rank)]; i < first_[static_cast<std::size_t>(rank) + 1];
       ++i) {
    const GlobalIndex cell = by_rank_[i];
    while (cell >= first_of_block + block->size()) first_of_block += (block++)->size();
    const auto in_block = static_cast<std::size_t>(cell - first_of_block);
    const auto stride = static_cast<std::size_t>(node_count(block->type));
    visit(*block, std::span(block->nodes).subspan(in_block * stride, stride), in_block, cell);
  }
}

/// The nodes of the rank's cells in the order of the share; fills slot_ for them.
std::vector<GlobalIndex> Dealer::nodes_of(int rank) {
  std::vector<GlobalIndex> nodes;
  for_each_cell_of(rank, [&](const CellBlock&, std::span<const GlobalIndex> cell, std::size_t, GlobalIndex) {
    for (const auto node : cell)
      if (std::exchange(slot_[static_cast<std::size_t>(node)], 0) < 0) nodes.push_back(node);
  });
  const auto owner = [&](GlobalIndex node) { return owner_[static_cast<std::size_t>(node)]; };
  std::sort(nodes.begin(), nodes.end(), [&](GlobalIndex a, GlobalIndex b) {
    return std::tuple(owner(a) != rank, owner(a), a) < std::tuple(owner(b) != rank, owner(b), b);
  });
  for (std::size_t i = 0; i < nodes.size(); ++i)
    slot_[static_cast<std::size_t>(nodes[i])] = static_cast<LocalIndex>(i);
  return nodes;
}

Share Dealer::share_of(int rank) {
  const auto nodes = nodes_of(rank);
  Share share;
  for (const auto node : nodes) {
    const auto n = static_cast<std::size_t>(node);
    share.nodes.push_back({node, natural_[n], owner_[n], mesh_.nodes[n]});
  }
  for (const auto& [type, region] : outline_.lists) {
    share.cells.emplace_back();
    share.cells.back().type = type;
    share.cells.back().region = region;
  }
  for_each_cell_of(rank, [&](const CellBlock& block, std::span<const GlobalIndex> cell, std::size_t in_block,
                             GlobalIndex number) {
    const auto list = std::lower_bound(outline_.lists.begin(), outline_.lists.end(),
                                       std::pair(block.type, block.region[in_block]));
    auto& cells = share.cells[static_cast<std::size_t>(list - outline_.lists.begin())];
    for (const auto node : cell) cells.nodes.push_back(slot_[static_cast<std::size_t>(node)]);
    cells.global_ids.push_back(number);
    if (!block.vectors.empty()) cells.vectors.push_back(block.vectors[in_block]);
  });
  for (const auto& set : mesh_.node_sets) {
    share.node_sets.push_back({set.name, {}});
    for (const auto node : set.nodes)
      if (owner_[static_cast<std::size_t>(node)] == rank)
        share.node_sets.back().owned.push_back(slot_[static_cast<std::size_t>(node)]);
  }
  for (const auto node : nodes) slot_[static_cast<std::size_t>(node)] = -1;
  return share;
}

void send_share(MPI_Comm comm, int to, const Share& share) {
  send(comm, to, share.nodes);
  for (const auto& cells : share.cells) {
    send(comm, to, cells.nodes);
    send(comm, to, cells.global_ids);
    send(comm, to, cells.vectors);
  }
  for (const auto& set : share.node_sets) send(comm, to, set.owned);
}

Share receive_share(MPI_Comm comm, const Outline& outline) {
  Share share;
  share.nodes = receive<SharedNode>(comm, 0);
  for (const auto& [type, region] : outline.lists) {
    auto nodes = receive<LocalIndex>(comm, 0);
    auto global_ids = receive<GlobalIndex>(comm, 0);
    auto vectors = receive<Vec3d>(comm, 0);
    share.cells.push_back({type, region, std::move(nodes), std::move(global_ids), std::move(vectors), 0});
  }
  for (const auto& name : outline.node_sets) share.node_sets.push_back({name, receive<LocalIndex>(comm, 0)});
  return share;
}

GlobalIndex count_used_nodes(const Mesh& mesh) {
  std::vector<bool> used(mesh.nodes.size());
  for (const auto& block : mesh.cells)
    for (const auto node : block.nodes) used[static_cast<std::size_t>(node)] = true;
  return std::count(used.begin(), used.end(), true);
}

Outline outline_of(const Mesh& mesh) {
  Outline outline;
  outline.total_nodes = count_used_nodes(mesh);
  outline.total_cells = mesh.cell_count();
  outline.regions = mesh.regions;
  for (const auto& set : mesh.node_sets) outline.node_sets.push_back(set.name);
  for (const auto& block : mesh.cells) {
    std::vector<bool> present(mesh.regions.size());
    for (const auto region : block.region) present[static_cast<std::size_t>(region)] = true;
    for (std::size_t region = 0; region < present.size(); ++region)
      if (present[region]) outline.lists.emplace_back(block.type, static_cast<std::int32_t>(region));
  }
  std::sort(outline.lists.begin(), outline.lists.end());
  constexpr GlobalIndex most = PETSC_MAX_INT / 3;
  if (outline.total_nodes > most)
    throw UserError("the mesh has " + std::to_string(outline.total_nodes) +
                    " nodes, and this PETSc counts to " + std::to_string(most) +
                    ": build against PETSc with 64-bit indices");
  return outline;
}

}  // namespace

Outline share_outline(MPI_Comm comm, const Mesh& mesh) {
  Outline outline;
  on_root(comm, [&] { outline = outline_of(mesh); });
  MPI_Bcast(&outline.total_nodes, 1, MPI_INT64_T, 0, comm);
  MPI_Bcast(&outline.total_cells, 1, MPI_INT64_T, 0, comm);
  auto lists = static_cast<int>(outline.lists.size());
  MPI_Bcast(&lists, 1, MPI_INT, 0, comm);
  outline.lists.resize(static_cast<std::size_t>(lists));
  for (auto& [type, region] : outline.lists) {
    MPI_Bcast(&type, 1, MPI_UINT8_T, 0, comm);
    MPI_Bcast(&region, 1, MPI_INT32_T, 0, comm);
  }
  broadcast(comm, outline.regions);
  broadcast(comm, outline.node_sets);
  return outline;
}

Share deal_out(MPI_Comm comm, const Outline& outline, const Mesh& mesh, const std::vector<int>& part) {
  if (rank_of(comm) != 0) return receive_share(comm, outline);
  Dealer dealer(outline, mesh, part, size_of(comm));
  for (int rank = 1; rank < size_of(comm); ++rank) send_share(comm, rank, dealer.share_of(rank));
  return dealer.share_of(0);
}

}  // namespace evert
