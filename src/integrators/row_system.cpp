#include "evert/integrators/row_system.hpp"

#include "evert/math/disjoint_sets.hpp"
#include "evert/math/nodal.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace evert {
namespace {

void update_ghosts(const Halo& halo, NodeField& field) {
  field.touched();
  halo.begin_update(field);
  halo.end_update(field);
}

void add_ghosts(const Halo& halo, NodeField& field) {
  halo.begin_add(field);
  halo.end_add(field);
  field.touched();
}

}  // namespace

RowSystem::RowSystem(const DistributedMesh& mesh, const ElasticForces& elastic, std::vector<Nodes> rows)
    : mesh_(mesh),
      halo_(elastic.halo()),
      masses_(elastic.masses()),
      nodes_(std::move(rows)),
      coefficients_(nodes_.size()),
      moved_(nodes_.size()),
      compliances_(nodes_.size()),
      scratch_(mesh) {
  for (const auto& row : nodes_)
    std::ranges::copy_if(row, std::back_inserter(used_), [](LocalIndex n) { return n >= 0; });
  std::ranges::sort(used_);
  used_.erase(std::ranges::unique(used_).begin(), used_.end());
  mobilities_.resize(used_.size());
  for (const auto& row : nodes_) {
    auto& slots = slots_.emplace_back();
    for (std::size_t a = 0; a < 4; ++a)
      slots[a] = row[a] < 0
                     ? -1
                     : static_cast<std::int32_t>(std::ranges::lower_bound(used_, row[a]) - used_.begin());
  }
  int ghosts = !used_.empty() && used_.back() >= mesh.owned_nodes ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &ghosts, 1, MPI_INT, MPI_MAX, mesh.comm);
  has_ghosts_ = ghosts != 0;
  if (has_ghosts_)
    for (int column = 0; column < 3; ++column) columns_.emplace_back(mesh);
  find_spanning_rows();
  find_pattern();
}

/// Clusters with a node that rows of several ranks have. Where no row has a ghost, no two ranks share one.
void RowSystem::find_spanning_rows() {
  std::vector<std::int32_t> spanning;
  const auto in_use = scratch_.local();
  std::ranges::fill(in_use, 0.0);
  for (const LocalIndex node : used_) in_use[3 * static_cast<std::size_t>(node)] = 1;
  if (has_ghosts_) {
    add_ghosts(halo_, scratch_);
    update_ghosts(halo_, scratch_);
  }
  DisjointSets clusters(static_cast<std::size_t>(mesh_.local_nodes()));
  const auto cluster_of = [&](LocalIndex node) { return clusters.root(static_cast<std::size_t>(node)); };
  for (const auto& row : nodes_)
    for (std::size_t a = 1; a < 4; ++a)
      if (row[a] >= 0) clusters.join(static_cast<std::size_t>(row[0]), static_cast<std::size_t>(row[a]));
  std::vector<bool> spans(static_cast<std::size_t>(mesh_.local_nodes()));
  for (const LocalIndex node : used_)
    if (in_use[3 * static_cast<std::size_t>(node)] > 1.5) spans[cluster_of(node)] = true;
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    (spans[cluster_of(nodes_[k][0])] ? spanning : inside_).push_back(static_cast<std::int32_t>(k));
  spanning_count_ = static_cast<GlobalIndex>(spanning.size());
  MPI_Allreduce(MPI_IN_PLACE, &spanning_count_, 1, MPI_INT64_T, MPI_SUM, mesh_.comm);
  if (spanning_count_ > 0)
    spanning_ = std::make_unique<SpanningRows>(mesh_, nodes_, std::move(spanning));
  else
    SpanningRows::read_options(mesh_.comm);
}

/// The lower triangle of S among the rows inside: pairs of rows that share a node, and the diagonal.
void RowSystem::find_pattern() {
  struct At {
    std::int32_t number, row;  // among inside_, of all
    std::int8_t slot;
  };
  std::vector<std::vector<At>> rows_at(used_.size());
  std::vector<SparseLdl::Entry> lower;
  std::vector<std::map<std::int32_t, std::int32_t>> entry_of(inside_.size());
  const auto entry = [&](std::int32_t i, std::int32_t j) {
    const auto [found, is_new] =
        entry_of[static_cast<std::size_t>(i)].try_emplace(j, static_cast<std::int32_t>(lower.size()));
    if (is_new) lower.push_back({i, j});
    return found->second;
  };
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    const auto number = static_cast<std::int32_t>(i);
    diagonal_.push_back(entry(number, number));
    for (std::int8_t a = 0; a < 4; ++a) {
      const auto slot = slots_[static_cast<std::size_t>(inside_[i])][static_cast<std::size_t>(a)];
      if (slot < 0) continue;
      auto& here = rows_at[static_cast<std::size_t>(slot)];
      here.push_back({number, inside_[i], a});
      for (const auto& other : here)
        terms_.push_back({entry(number, other.number), inside_[i], other.row, a, other.slot});
    }
  }
  entries_.resize(lower.size());
  right_.resize(inside_.size());
  if (!inside_.empty()) ldl_.emplace(static_cast<SparseLdl::Index>(inside_.size()), lower);
}

/// W at the used nodes that are owned.
void RowSystem::set_mobilities(std::span<const NodeConstraint> held) {
  auto constraint = held.begin();
  for (std::size_t u = 0; u < used_.size() && used_[u] < mesh_.owned_nodes; ++u) {
    const double inverse_mass = 1 / masses_[static_cast<std::size_t>(used_[u])];
    while (constraint != held.end() && constraint->node < used_[u]) ++constraint;
    const bool is_held = constraint != held.end() && constraint->node == used_[u];
    mobilities_[u] = inverse_mass * (is_held ? constraint->free : identity<double>());
  }
}

/// Those of ghosts from their owners, where these have them as well as where they do not.
void RowSystem::share_mobilities(std::span<const NodeConstraint> held) {
  for (std::size_t column = 0; column < 3; ++column) {
    const auto values = columns_[column].owned();
    std::ranges::fill(values, 0.0);
    for (std::size_t node = 0; node < masses_.size(); ++node) values[3 * node + column] = 1 / masses_[node];
    for (const auto& c : held)
      set_node_value(values, c.node, (1 / masses_[static_cast<std::size_t>(c.node)]) * c.free.column[column]);
    update_ghosts(halo_, columns_[column]);
    for (std::size_t u = used_.size(); u-- > 0 && used_[u] >= mesh_.owned_nodes;)
      mobilities_[u].column[column] = node_value(columns_[column].local(), used_[u]);
  }
}

/// Collective where rows have ghosts. Whether a node is held that rows have.
bool RowSystem::any_held(std::span<const NodeConstraint> held) const {
  int any = std::ranges::any_of(
      held, [&](const NodeConstraint& c) { return std::ranges::binary_search(used_, c.node); });
  if (!has_ghosts_) return any != 0;
  any = held.empty() ? 0 : 1;  // the row may be another rank's
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, mesh_.comm);
  return any != 0;
}

void RowSystem::factor(std::span<const NodeConstraint> held) {
  const bool now_held = any_held(held);
  if (!stale_ && !now_held && !held_) return;
  stale_ = false;
  held_ = now_held;
  set_mobilities(held);
  if (has_ghosts_) share_mobilities(held);
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    for (std::size_t a = 0; a < 4; ++a)
      if (slots_[k][a] >= 0)
        moved_[k][a] = mobilities_[static_cast<std::size_t>(slots_[k][a])] * coefficients_[k][a];
  fill_inside();
  if (spanning_) spanning_->assemble(coefficients_, moved_, compliances_);
}

/// Where S is not positive definite, since something in it is not finite, so will the solutions be: every
/// rank notices at the end of the step.
void RowSystem::fill_inside() {
  if (!ldl_) return;
  std::ranges::fill(entries_, 0.0);
  const auto at = [](std::int32_t k) { return static_cast<std::size_t>(k); };
  for (const auto& [entry, row, column, a, b] : terms_)
    entries_[at(entry)] += dot(moved_[at(row)][at(a)], coefficients_[at(column)][at(b)]);
  for (std::size_t i = 0; i < inside_.size(); ++i) entries_[at(diagonal_[i])] += compliances_[at(inside_[i])];
  definite_ = ldl_->factor(entries_);
}

void RowSystem::solve(std::span<double> b) {
  if (ldl_) {
    for (std::size_t i = 0; i < inside_.size(); ++i) right_[i] = b[static_cast<std::size_t>(inside_[i])];
    if (definite_)
      ldl_->solve(right_);
    else
      std::ranges::fill(right_, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < inside_.size(); ++i) b[static_cast<std::size_t>(inside_[i])] = right_[i];
  }
  if (spanning_) spanning_->solve(b);
}

void RowSystem::apply(NodeField& v, std::span<double> values) const {
  if (has_ghosts_) update_ghosts(halo_, v);
  const auto at_nodes = std::as_const(v).local();
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    values[k] = 0;
    for (std::size_t a = 0; a < 4; ++a)
      if (nodes_[k][a] >= 0) values[k] += dot(coefficients_[k][a], node_value(at_nodes, nodes_[k][a]));
  }
}

/// Into scratch_: Jᵀ values at the used nodes, those of other ranks included where they are owned.
void RowSystem::spread(std::span<const double> values) const {
  const auto sums = scratch_.local();
  if (has_ghosts_)  // other ranks may add to any node
    std::ranges::fill(sums, 0.0);
  else
    for (const LocalIndex node : used_) set_node_value(sums, node, {});
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    for (std::size_t a = 0; a < 4; ++a)
      if (nodes_[k][a] >= 0)
        for (std::size_t i = 0; i < 3; ++i)
          sums[3 * static_cast<std::size_t>(nodes_[k][a]) + i] += values[k] * coefficients_[k][a][i];
  if (has_ghosts_) add_ghosts(halo_, scratch_);
}

void RowSystem::take_off(std::span<const double> values, std::span<const NodeConstraint> held,
                         NodeField& v) const {
  spread(values);
  project(held, scratch_.owned());
  for_each_touched([&](LocalIndex node) {
    const Vec3d change = (1 / masses_[static_cast<std::size_t>(node)]) * node_value(scratch_.owned(), node);
    set_node_value(v.owned(), node, node_value(v.owned(), node) - change);
  });
  v.touched();
}

void RowSystem::add_transposed(std::span<const double> values, NodeField& v) const {
  spread(values);
  for_each_touched([&](LocalIndex node) {
    set_node_value(v.owned(), node, node_value(v.owned(), node) + node_value(scratch_.owned(), node));
  });
  v.touched();
}

void RowSystem::add_diagonal(NodeField& normal, NodeField& shear) const {
  const auto add = [&](auto&& of_row, NodeField& sum) {
    std::ranges::fill(scratch_.local(), 0.0);
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      for (std::size_t a = 0; a < 4; ++a) {
        if (nodes_[k][a] < 0) continue;
        const Vec3d block = (1 / compliances_[k]) * of_row(coefficients_[k][a]);
        set_node_value(scratch_.local(), nodes_[k][a], node_value(scratch_.local(), nodes_[k][a]) + block);
      }
    if (has_ghosts_) add_ghosts(halo_, scratch_);
    for (std::size_t i = 0; i < sum.owned().size(); ++i) sum.owned()[i] += scratch_.owned()[i];
  };
  add([](const Vec3d& j) { return Vec3d{j[0] * j[0], j[1] * j[1], j[2] * j[2]}; }, normal);
  add([](const Vec3d& j) { return Vec3d{j[1] * j[2], j[0] * j[2], j[0] * j[1]}; }, shear);
}

/// Owned nodes that rows may have.
template <class Visit>
void RowSystem::for_each_touched(Visit&& visit) const {
  if (has_ghosts_) {
    for (LocalIndex node = 0; node < mesh_.owned_nodes; ++node) visit(node);
    return;
  }
  for (const LocalIndex node : used_) visit(node);
}

}  // namespace evert
