#include "evert/forces/elastic_forces.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/log.hpp"
#include "evert/forces/plastic_cells.hpp"

#include "consistent_bound.hpp"
#include "mass_shares.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace evert {
namespace {

// Operations per quadrature point as PETSc's log books them, counted once in the tet4 kernels: gather and F,
// its singular values, stress, scatter; and the two products of the damping operator.
constexpr double force_flops = 560;
constexpr double damping_flops = 125;

ElasticCells cells_of(const LocalCells& cells, double density) {
  return {cells.type, cells.nodes, cells.interior, density, cells.vectors};
}

ElasticCells cells_of(const LocalCells& cells, const ElasticProperties& properties) {
  auto of_region = cells_of(cells, properties.density);
  of_region.mean_dilatation = properties.mean_dilatation;
  of_region.plasticity = properties.plasticity;
  return of_region;
}

BatchRange first_half(BatchRange range) { return {range.begin, range.begin + (range.end - range.begin) / 2}; }
BatchRange second_half(BatchRange range) { return {first_half(range).end, range.end}; }

void clear(std::span<double> values) { std::fill(values.begin(), values.end(), 0.0); }

/// Runs `compute` over all batches while values travel: half of the interior hides the update of `in`, the
/// other half the sum of `out`, and the boundary stands between.
/// `at_boundary` is called while the ghosts of both are at hand.
template <class Compute, class AtBoundary>
void overlapped(const Halo& halo, std::span<const std::unique_ptr<ElasticBlock>> blocks, NodeField& in,
                NodeField& out, Compute&& compute, AtBoundary&& at_boundary) {
  const auto each = [&](auto&& range_of) {
    for (const auto& block : blocks)
      if (block != nullptr) compute(*block, range_of(*block));
  };
  halo.begin_update(in);
  each([](const ElasticBlock& block) { return first_half(block.interior()); });
  halo.end_update(in);
  each([](const ElasticBlock& block) { return block.boundary(); });
  at_boundary();
  halo.begin_add(out);
  each([](const ElasticBlock& block) { return second_half(block.interior()); });
  halo.end_add(out);
}

constexpr auto nothing = [] {};

double points_of(const DistributedMesh& mesh) {
  double points = 0;
  for (const auto& cells : mesh.cells)
    points += quadrature_points(cells.type) * static_cast<double>(cells.size());
  return points;
}

}  // namespace

ElasticForces::ElasticForces(const DistributedMesh& mesh, std::span<const ElasticProperties> properties,
                             MassForm mass)
    : mesh_(mesh), halo_(mesh), properties_(properties.begin(), properties.end()), scratch_(mesh) {
  const auto properties_of = [&](const LocalCells& cells) -> const ElasticProperties& {
    return properties[static_cast<std::size_t>(cells.region)];
  };
  on_every_rank(mesh.comm, [&] {
    for (const auto& cells : mesh.cells) {
      const auto& of_cells = properties_of(cells);
      blocks_.push_back(cells.size() == 0
                            ? nullptr
                            : make_elastic_block(cells_of(cells, of_cells), mesh.rest_positions,
                                                 of_cells.material, of_cells.damping, of_cells.precision));
      damped_ = damped_ || of_cells.damping.model != DampingModel::none;
    }
  });

  masses_ = lumped(densities());
  balance_masses(mesh_, halo_, masses_, blocks_);
  if (mass == MassForm::consistent) {
    lumped_over_consistent_ = lumped_over_consistent(mesh_);
    consistent_mass_ = std::make_unique<ConsistentMass>(mesh_, halo_, densities());
    bound_consistent_step();
  }

  const auto has_mass_damping = [](const ElasticProperties& p) {
    return p.mass_proportional_damping.has_value();
  };
  if (std::ranges::none_of(properties, has_mass_damping)) return;
  damped_ = true;
  for (const auto& of_region : properties)
    damped_densities_.push_back(of_region.density * of_region.mass_proportional_damping.value_or(0));
  make_mass_damping();
}

/// Of two bounds of λmax(M⁻¹K) the smaller: that of lumped masses times the ratio of these, and the largest
/// eigenvalue of any cell by itself, as long as its shape does not flow. docs/design/time-stepping.md
void ElasticForces::bound_consistent_step() {
  if (may_flow()) {
    step_over_lumped_ = 1 / std::sqrt(lumped_over_consistent_);
    return;
  }
  const double of_cells = consistent_over_block_stiffness(mesh_, densities(), blocks_);
  step_over_lumped_ = 1 / std::sqrt(std::min(lumped_over_consistent_, of_cells));
}

void ElasticForces::make_mass_damping() {
  if (consistent_mass_ == nullptr) {
    mass_damping_ = lumped(damped_densities_);
    return;
  }
  consistent_mass_damping_ = std::make_unique<ConsistentMass>(mesh_, halo_, damped_densities_);
  const auto sums = consistent_mass_damping_->row_sums();
  mass_damping_.assign(sums.begin(), sums.end());
}

std::vector<double> ElasticForces::densities() const {
  std::vector<double> per_region;
  for (const auto& of_region : properties_) per_region.push_back(of_region.density);
  return per_region;
}

std::vector<double> ElasticForces::lumped(std::span<const double> densities) {
  std::vector<double> local(static_cast<std::size_t>(mesh_.local_nodes()));
  for (const auto& cells : mesh_.cells)
    add_lumped_mass(cells_of(cells, densities[static_cast<std::size_t>(cells.region)]), mesh_.rest_positions,
                    local);
  auto summed = scratch_.local();
  for (std::size_t i = 0; i < summed.size(); ++i) summed[i] = local[i / 3];
  halo_.begin_add(scratch_);
  halo_.end_add(scratch_);
  std::vector<double> owned(static_cast<std::size_t>(mesh_.owned_nodes));
  for (std::size_t i = 0; i < owned.size(); ++i) owned[i] = summed[3 * i];
  return owned;
}

void ElasticForces::update(NodeField& x, NodeField& f) {
  const PhaseScope scope(Phase::force, force_flops * points_of(mesh_));
  clear(f.local());
  const auto compute = [&](ElasticBlock& block, BatchRange batches) {
    block.update(x.local().data(), f.local().data(), batches);
  };
  overlapped(halo_, blocks_, x, f, compute, nothing);
  f.touched();
}

template <class AtBoundary>
void ElasticForces::damp(NodeField& v, NodeField& out, double factor, AtBoundary&& at_boundary) const {
  const PhaseScope scope(Phase::damping_apply, damping_flops * points_of(mesh_));
  clear(out.local().subspan(out.owned().size()));
  const auto velocity = v.owned();
  const auto sum = out.owned();
  if (consistent_mass_damping_ == nullptr) {
    for (std::size_t node = 0; node < mass_damping_.size(); ++node) {
      const double of_node = factor * mass_damping_[node];
      for (std::size_t i = 3 * node; i < 3 * node + 3; ++i) sum[i] += of_node * velocity[i];
    }
  }
  const auto compute = [&](const ElasticBlock& block, BatchRange batches) {
    if (block.damped()) block.add_damping(v.local().data(), out.local().data(), factor, batches);
  };
  overlapped(halo_, blocks_, v, out, compute, at_boundary);
  out.touched();
}

void ElasticForces::add_damping(NodeField& v, NodeField& out, double factor) const {
  if (consistent_mass_damping_ == nullptr) return damp(v, out, factor, nothing);
  damp(v, out, factor, [&] { consistent_mass_damping_->add(v.local(), out.local(), factor); });
}

void ElasticForces::add_momentum_and_damping(NodeField& v, NodeField& out, double factor) const {
  if (!damped_) return add_momentum(v, out);
  damp(v, out, factor, [&] {
    consistent_mass_->add(v.local(), out.local(), 1);
    if (consistent_mass_damping_ != nullptr) consistent_mass_damping_->add(v.local(), out.local(), factor);
  });
}

void ElasticForces::add_momentum(NodeField& v, NodeField& out) const {
  const PhaseScope scope(Phase::damping_apply, consistent_mass_->flops());
  clear(out.local().subspan(out.owned().size()));
  const auto multiply = [&] { consistent_mass_->add(v.local(), out.local(), 1); };
  overlapped(
      halo_, {}, v, out, [](const ElasticBlock&, BatchRange) {}, multiply);
  out.touched();
}

void ElasticForces::damping_diagonal(NodeField& normal, NodeField& shear) const {
  clear(normal.local());
  clear(shear.local());
  for (const auto& block : blocks_) {
    if (block != nullptr && block->damped())
      block->add_damping_diagonal(normal.local().data(), shear.local().data(), 1.0);
  }
  for (NodeField* field : {&normal, &shear}) {
    halo_.begin_add(*field);
    halo_.end_add(*field);
  }
  const auto proportional = consistent_mass_damping_ != nullptr ? consistent_mass_damping_->diagonal()
                                                                : std::span<const double>(mass_damping_);
  for (std::size_t i = 0; i < 3 * proportional.size(); ++i) normal.owned()[i] += proportional[i / 3];
}

double ElasticForces::energy(const NodeField& x) const {
  double sum = 0;
  for (const auto& block : blocks_)
    if (block != nullptr) sum += block->energy(x.local().data());
  return sum;
}

LocalIndex ElasticForces::inverted_points(const NodeField& x) const {
  const PhaseScope scope(Phase::stretch_svd);
  LocalIndex sum = 0;
  for (const auto& block : blocks_)
    if (block != nullptr) sum += block->inverted_points(x.local().data());
  return sum;
}

StableStep ElasticForces::stable_step(const NodeField& x) const {
  const PhaseScope scope(Phase::stretch_svd);
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  StableStep smallest{unbounded, unbounded};
  for (const auto& block : blocks_) {
    if (block == nullptr) continue;
    const auto step = block->stable_step(x.local().data());
    smallest.undamped = std::min(smallest.undamped, step.undamped);
    smallest.damped = std::min(smallest.damped, step.damped);
  }
  smallest.undamped *= step_over_lumped_;
  smallest.damped *= step_over_lumped_;
  return smallest;
}

double ElasticForces::max_strain_rate(const NodeField& x, const NodeField& v) const {
  const PhaseScope scope(Phase::stretch_svd);
  double largest = 0;
  for (const auto& block : blocks_)
    if (block != nullptr)
      largest = std::max(largest, block->max_strain_rate(x.local().data(), v.local().data()));
  return largest;
}

void ElasticForces::min_stretch(const NodeField& x, std::size_t entry, std::span<double> per_cell) const {
  const PhaseScope scope(Phase::stretch_svd);
  if (separations_.empty()) {
    if (blocks_[entry] != nullptr) blocks_[entry]->min_stretch(x.local().data(), per_cell);
    return;
  }
  std::vector<double> of_block;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (blocks_[b] == nullptr || entry_of(b) != entry) continue;
    const auto cells = cells_in(b);
    of_block.resize(cells.size());
    blocks_[b]->min_stretch(x.local().data(), of_block);
    for (std::size_t i = 0; i < cells.size(); ++i) per_cell[static_cast<std::size_t>(cells[i])] = of_block[i];
  }
}

std::size_t ElasticForces::entry_of(std::size_t block) const {
  return block < mesh_.cells.size() ? block : separations_[block - mesh_.cells.size()].entry;
}

std::vector<LocalIndex> ElasticForces::cells_in(std::size_t block) const {
  if (block >= mesh_.cells.size()) return separations_[block - mesh_.cells.size()].cells;
  std::vector<bool> separate(static_cast<std::size_t>(mesh_.cells[block].size()));
  for (const auto& [entry, cells] : separations_)
    if (entry == block)
      for (const LocalIndex cell : cells) separate[static_cast<std::size_t>(cell)] = true;
  std::vector<LocalIndex> rest;
  for (LocalIndex cell = 0; cell < mesh_.cells[block].size(); ++cell)
    if (!separate[static_cast<std::size_t>(cell)]) rest.push_back(cell);
  return rest;
}

bool ElasticForces::is_of_region(std::size_t block, std::int32_t region) const {
  return blocks_[block] != nullptr && mesh_.cells[entry_of(block)].region == region;
}

std::unique_ptr<ElasticBlock> ElasticForces::make_block(std::size_t entry,
                                                        std::span<const LocalIndex> cells) const {
  if (cells.empty()) return nullptr;
  const auto& all = mesh_.cells[entry];
  const auto& properties = properties_[static_cast<std::size_t>(all.region)];
  const auto nodes_a_cell = static_cast<std::size_t>(node_count(all.type));
  LocalCells chosen{.type = all.type, .region = all.region, .nodes = {}, .global_ids = {}};
  for (const LocalIndex cell : cells) {
    const auto nodes =
        std::span(all.nodes).subspan(nodes_a_cell * static_cast<std::size_t>(cell), nodes_a_cell);
    chosen.nodes.insert(chosen.nodes.end(), nodes.begin(), nodes.end());
    if (!all.vectors.empty()) chosen.vectors.push_back(all.vectors[static_cast<std::size_t>(cell)]);
    chosen.interior += cell < all.interior ? 1 : 0;
  }
  return make_elastic_block(cells_of(chosen, properties), mesh_.rest_positions, properties.material,
                            properties.damping, properties.precision);
}

void ElasticForces::separate(std::vector<SeparateCells> separate_cells) {
  EVERT_ASSERT(consistent_mass_ == nullptr, std::to_string(separate_cells.size()));
  for (auto& [entry, cells, block] : separate_cells) {
    const auto flown = flow(entry);
    std::vector<double> way(static_cast<std::size_t>(mesh_.cells[entry].size()));
    way_of_flow(entry, way);
    for (std::size_t s = separations_.size(); s-- > 0;) {
      if (separations_[s].entry != entry) continue;
      separations_.erase(separations_.begin() + static_cast<std::ptrdiff_t>(s));
      blocks_.erase(blocks_.begin() + static_cast<std::ptrdiff_t>(mesh_.cells.size() + s));
    }
    if (!cells.empty()) {
      separations_.push_back({entry, std::move(cells)});
      blocks_.push_back(std::move(block));
    }
    blocks_[entry] = make_block(entry, cells_in(entry));
    for (const auto& goal : goals_)
      for (std::size_t b = 0; b < blocks_.size(); ++b)
        if (entry_of(b) == entry) apply(goal, b);
    set_flow(entry, flown);
    set_way_of_flow(entry, way);
  }
  balance_masses(mesh_, halo_, masses_, blocks_);
}

void ElasticForces::set_properties(std::int32_t region, const ElasticProperties& properties) {
  properties_[static_cast<std::size_t>(region)] = properties;
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    if (is_of_region(i, region)) {
      blocks_[i]->set_material(properties.material, properties.damping);
      if (blocks_[i]->plastic() != nullptr) blocks_[i]->plastic()->set_law(*properties.plasticity);
    }
  balance_masses(mesh_, halo_, masses_, blocks_);
  if (consistent_mass_ != nullptr) bound_consistent_step();
  if (damped_densities_.empty()) return;
  damped_densities_[static_cast<std::size_t>(region)] =
      properties.density * properties.mass_proportional_damping.value_or(0);
  make_mass_damping();
}

void ElasticForces::set_activation(std::int32_t region, double activation) {
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    if (is_of_region(i, region)) blocks_[i]->set_activation(activation);
}

std::size_t ElasticForces::memory() const {
  std::size_t bytes = mass_damping_.capacity() * sizeof(double);
  for (const auto* mass : {consistent_mass(), consistent_mass_damping()})
    if (mass != nullptr) bytes += mass->memory();
  for (const auto& block : blocks_)
    if (block != nullptr) bytes += block->memory();
  return bytes;
}

}  // namespace evert
