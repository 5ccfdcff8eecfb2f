#include "evert/core/collective.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include "renumber.hpp"
#include "share.hpp"
#include <algorithm>
#include <numeric>

namespace evert {
namespace {

std::vector<int> offsets_of(const std::vector<int>& counts) {
  std::vector<int> offsets(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
  return offsets;
}

/// Collective. Asks the owners of `ghosts` (sorted by owner) for the PETSc numbers they gave to them. `owned`
/// are the natural numbers of this rank's nodes in their final order.
std::vector<GlobalIndex> numbers_from_owners(MPI_Comm comm, std::span<const SharedNode> ghosts,
                                             const std::vector<GlobalIndex>& owned, GlobalIndex first_owned) {
  const auto ranks = static_cast<std::size_t>(size_of(comm));
  std::vector<int> asked(ranks);
  std::vector<GlobalIndex> questions;
  for (const auto& ghost : ghosts) {
    ++asked[static_cast<std::size_t>(ghost.owner)];
    questions.push_back(ghost.natural);
  }
  std::vector<int> heard(ranks);
  MPI_Alltoall(asked.data(), 1, MPI_INT, heard.data(), 1, MPI_INT, comm);
  const auto asked_at = offsets_of(asked);
  const auto heard_at = offsets_of(heard);
  std::vector<GlobalIndex> answers(static_cast<std::size_t>(heard_at.back() + heard.back()));
  MPI_Alltoallv(questions.data(), asked.data(), asked_at.data(), MPI_INT64_T, answers.data(), heard.data(),
                heard_at.data(), MPI_INT64_T, comm);

  std::vector<std::pair<GlobalIndex, GlobalIndex>> number_of;  // natural → PETSc
  for (const auto natural : owned)
    number_of.emplace_back(natural, first_owned + static_cast<GlobalIndex>(number_of.size()));
  std::sort(number_of.begin(), number_of.end());
  for (auto& natural : answers)
    natural =
        std::lower_bound(number_of.begin(), number_of.end(), std::pair(natural, GlobalIndex{0}))->second;

  std::vector<GlobalIndex> numbers(questions.size());
  MPI_Alltoallv(answers.data(), heard.data(), heard_at.data(), MPI_INT64_T, numbers.data(), asked.data(),
                asked_at.data(), MPI_INT64_T, comm);
  return numbers;
}

/// Number of the first node owned by this rank when ranks number theirs one after the other.
GlobalIndex first_of(MPI_Comm comm, GlobalIndex owned) {
  GlobalIndex first = 0;
  MPI_Exscan(&owned, &first, 1, MPI_INT64_T, MPI_SUM, comm);
  return rank_of(comm) == 0 ? 0 : first;
}

/// Gives the nodes of the share their final order: result[local number] = number in the share. Fills all that
/// `mesh` says about nodes. Collective.
std::vector<LocalIndex> order_nodes(DistributedMesh& mesh, const Share& share) {
  const auto owned = static_cast<std::size_t>(
      std::count_if(share.nodes.begin(), share.nodes.end(),
                    [rank = rank_of(mesh.comm)](const SharedNode& node) { return node.owner == rank; }));
  mesh.owned_nodes = static_cast<LocalIndex>(owned);
  mesh.ghost_nodes = static_cast<LocalIndex>(share.nodes.size() - owned);
  mesh.first_owned = first_of(mesh.comm, mesh.owned_nodes);

  std::vector<LocalIndex> order = locality_order(mesh.owned_nodes, share.cells);
  for (const auto old : order)
    mesh.natural_nodes.push_back(share.nodes[static_cast<std::size_t>(old)].natural);

  const auto ghosts = std::span(share.nodes).subspan(owned);
  const auto numbers = numbers_from_owners(mesh.comm, ghosts, mesh.natural_nodes, mesh.first_owned);
  order.resize(share.nodes.size());
  const auto ghost_order = order.begin() + mesh.owned_nodes;
  std::iota(ghost_order, order.end(), mesh.owned_nodes);
  const auto number_of = [&](LocalIndex node) {
    return numbers[static_cast<std::size_t>(node - mesh.owned_nodes)];
  };
  std::sort(ghost_order, order.end(),
            [&](LocalIndex a, LocalIndex b) { return number_of(a) < number_of(b); });
  std::transform(ghost_order, order.end(), std::back_inserter(mesh.ghost_globals), number_of);

  for (const auto old : order) {
    const auto& node = share.nodes[static_cast<std::size_t>(old)];
    mesh.original_nodes.push_back(node.original);
    mesh.rest_positions.push_back(node.position);
  }
  return order;
}

void relabel(std::vector<LocalIndex>& nodes, const std::vector<LocalIndex>& new_number) {
  for (auto& node : nodes) node = new_number[static_cast<std::size_t>(node)];
}

}  // namespace

DistributedMesh distribute(MPI_Comm comm, const Mesh& mesh, const DistributionOptions& options) {
  const auto part = partition_cells(comm, mesh, options.partitioner);
  auto outline = share_outline(comm, mesh);
  auto share = deal_out(comm, outline, mesh, part);

  DistributedMesh result;
  result.comm = comm;
  result.total_nodes = outline.total_nodes;
  result.total_cells = outline.total_cells;
  result.regions = std::move(outline.regions);
  const auto order = order_nodes(result, share);
  std::vector<LocalIndex> new_number(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    new_number[static_cast<std::size_t>(order[i])] = static_cast<LocalIndex>(i);

  result.cells = std::move(share.cells);
  for (auto& cells : result.cells) {
    relabel(cells.nodes, new_number);
    sort_cells(cells, result.owned_nodes);
  }
  result.node_sets = std::move(share.node_sets);
  for (auto& set : result.node_sets) {
    relabel(set.owned, new_number);
    std::sort(set.owned.begin(), set.owned.end());
  }
  return result;
}

}  // namespace evert
