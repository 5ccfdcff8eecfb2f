#include "evert/integrators/implicit_strains.hpp"

#include "evert/core/log.hpp"

#include "vec_view.hpp"
#include <algorithm>

namespace evert {
namespace {

// What is this much stiffer than at rest is rigid for any step.
constexpr double most_growth = 1e6;

}  // namespace

ImplicitStrains::ImplicitStrains(const DistributedMesh& mesh, const ElasticForces& elastic,
                                 const ModalFilter& filter)
    : mesh_(mesh), elastic_(elastic), filter_(filter), change_(mesh), product_(mesh) {
  rebuild();
}

void ImplicitStrains::rebuild() {
  std::vector<RowSystem::Nodes> nodes;
  for (const auto& cell : filter_.stiff_cells()) nodes.insert(nodes.end(), cell.modes.size(), cell.nodes);
  values_.resize(nodes.size());
  rows_.emplace(mesh_, elastic_, std::move(nodes));
  std::ranges::fill(rows_->compliances(), 1.0);  // of zero rows, until it is known of what step
  revision_ = filter_.revision();
  dt_ = 0;
}

void ImplicitStrains::prepare(const NodeField& x, double dt, std::uint64_t state) {
  const PhaseScope phase(Phase::filter);
  if (revision_ != filter_.revision()) rebuild();
  // Steps of one length differ by the rounding of the time: θ need not follow that.
  const double length = static_cast<float>(dt);
  if (length == dt_ && state == state_) return;
  const double factor = filter_.options().implicit_factor(length);
  std::size_t first = 0;
  for (const auto& cell : filter_.stiff_cells()) {
    const auto count = cell.modes.size();
    const double growth = stiff_rows(cell, elastic_.properties(cell.region).material, x.local(),
                                     rows_->coefficients().subspan(first, count));
    for (std::size_t k = 0; k < count; ++k)
      rows_->compliances()[first + k] = 1 / (factor * std::min(growth, most_growth) * cell.modes[k].weight);
    first += count;
  }
  dt_ = length;
  state_ = state;
  ++changes_;
  rows_->changed();
}

/// By Woodbury's identity: M⁻¹ b − W Jᵀ (1/w + J W Jᵀ)⁻¹ J M⁻¹ b.
void ImplicitStrains::solve(Vec momentum, Vec change, std::span<const NodeConstraint> held) {
  const PhaseScope phase(Phase::filter);
  const auto masses = elastic_.masses();
  {
    const VecView given(momentum);
    for (std::size_t i = 0; i < given.values().size(); ++i)
      change_.owned()[i] = given.values()[i] / masses[i / 3];
  }
  change_.touched();
  rows_->apply(change_, values_);
  rows_->factor(held);
  rows_->solve(values_);
  rows_->take_off(values_, held, change_);
  const VecView found(change);
  std::ranges::copy(change_.owned(), found.values().begin());
}

void ImplicitStrains::add_product(NodeField& v, NodeField& out) {
  const PhaseScope phase(Phase::filter);
  rows_->apply(v, values_);
  for (std::size_t k = 0; k < values_.size(); ++k) values_[k] /= rows_->compliances()[k];
  rows_->add_transposed(values_, out);
}

void ImplicitStrains::add_product(Vec v, Vec out, double factor) {
  {
    const VecView given(v);
    std::ranges::copy(given.values(), change_.owned().begin());
  }
  change_.touched();
  std::ranges::fill(product_.owned(), 0.0);
  add_product(change_, product_);
  const VecView sum(out);
  for (std::size_t i = 0; i < sum.values().size(); ++i) sum.values()[i] += factor * product_.owned()[i];
}

}  // namespace evert
