#include "evert/integrators/shape_projection.hpp"

#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/core/log.hpp"
#include "evert/math/nodal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace evert {
namespace {

constexpr double tolerance = 1e-6;       // of the length of a constraint
constexpr double regularisation = 1e-8;  // of the diagonal of S
constexpr int most_iterations = 30;

}  // namespace

ShapeProjection::ShapeProjection(const DistributedMesh& mesh, const ElasticForces& elastic,
                                 std::vector<ShapeConstraint> constraints, FilterProjection form)
    : mesh_(mesh), elastic_(elastic), form_(form), all_(std::move(constraints)), before_(mesh) {
  NodeField inverse(mesh);
  for (std::size_t i = 0; i < inverse.owned().size(); ++i) inverse.owned()[i] = 1 / elastic.masses()[i / 3];
  inverse.touched();
  elastic.halo().begin_update(inverse);
  elastic.halo().end_update(inverse);
  for (std::size_t i = 0; i < inverse.local().size(); i += 3) inverse_masses_.push_back(inverse.local()[i]);
  rebuild();
}

ShapeProjection::ShapeProjection(const DistributedMesh& mesh, const ElasticForces& elastic,
                                 const ModalFilter& filter)
    : ShapeProjection(mesh, elastic, filter.shape_constraints(), filter.options().projection) {
  filter_ = &filter;
  sweeps_ = filter.options().projection_sweeps;
  revision_ = filter.revision();
}

/// Collective. Whether other nodes are fixed than before, on any rank.
bool ShapeProjection::follow(std::span<const NodeConstraint> prescribed) {
  const auto is_fixed = [](const NodeConstraint& c) { return trace(c.free) < 0.5; };  // the rank of P
  auto known = fixed_.begin();
  int changed = 0;
  for (const auto& c : prescribed)
    if (is_fixed(c) && (known == fixed_.end() || *known++ != c.node)) changed = 1;
  if (known != fixed_.end()) changed = 1;
  MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, mesh_.comm);
  if (changed == 0) return false;
  fixed_.clear();
  for (const auto& c : prescribed)
    if (is_fixed(c)) fixed_.push_back(c.node);
  return true;
}

/// Collective. Rows of the constraints that have a node that is not fixed.
void ShapeProjection::rebuild() {
  NodeField fixed(mesh_);
  for (const LocalIndex node : fixed_) set_node_value(fixed.owned(), node, {1, 0, 0});
  fixed.touched();
  elastic_.halo().begin_update(fixed);
  elastic_.halo().end_update(fixed);
  const auto can_move = [&](LocalIndex node) {
    return node >= 0 && node_value(std::as_const(fixed).local(), node)[0] == 0;
  };
  constraints_ = all_;
  const auto rest = std::ranges::stable_partition(
      constraints_, [&](const ShapeConstraint& c) { return std::ranges::any_of(c.nodes, can_move); });
  std::vector<RowSystem::Nodes> nodes;
  for (auto constraint = constraints_.begin(); constraint != rest.begin(); ++constraint)
    nodes.push_back(constraint->nodes);
  values_.resize(constraints_.size());
  rows_.emplace(mesh_, elastic_, std::move(nodes));
}

/// J at `x`, and what S is regularised by.
void ShapeProjection::set_rows(const NodeField& x) {
  for (std::size_t k = 0; k < rows_->size(); ++k) {
    const auto& constraint = constraints_[k];
    auto& row = rows_->coefficients()[k];
    static_cast<void>(violation(constraint, x.local(), row));
    double diagonal = 0;
    for (std::size_t a = 0; a < 4; ++a)
      if (constraint.nodes[a] >= 0)
        diagonal += inverse_masses_[static_cast<std::size_t>(constraint.nodes[a])] * dot(row[a], row[a]);
    rows_->compliances()[k] = regularisation * diagonal;
  }
  rows_->changed();
}

/// Collective. values_ = C at `x`, brought up to date; returns the largest, in lengths, over all ranks.
double ShapeProjection::take_violations(NodeField& x) {
  if (rows_->has_ghosts()) {
    elastic_.halo().begin_update(x);
    elastic_.halo().end_update(x);
  }
  double largest = 0;
  TetRow gradient;
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    values_[k] = violation(constraints_[k], std::as_const(x).local(), gradient);
    const double share = std::abs(values_[k]) / constraints_[k].rest;
    largest = share <= largest ? largest : share;  // NaN is the largest
  }
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, mesh_.comm);
  return largest;
}

void ShapeProjection::begin(const NodeField& x, std::span<const NodeConstraint> prescribed) {
  const PhaseScope phase(Phase::filter);
  bool is_new = follow(prescribed);
  if (filter_ != nullptr && revision_ != filter_->revision()) {
    all_ = filter_->shape_constraints();
    revision_ = filter_->revision();
    is_new = true;
  }
  if (is_new) rebuild();
  if (form_ == FilterProjection::shake) set_rows(x);
}

/// Whether all of the constraint's nodes are held in its directions.
bool ShapeProjection::is_held(std::size_t k) const {
  if (k >= rows_->size()) return true;
  constexpr double rounding = 1e-12;
  double moved = 0, free = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    const LocalIndex node = rows_->nodes()[k][a];
    if (node < 0) continue;
    moved += norm(rows_->moved()[k][a]);
    free +=
        inverse_masses_[static_cast<std::size_t>(node)] * norm(std::as_const(*rows_).coefficients()[k][a]);
  }
  return moved <= rounding * free;
}

/// Collective. Throws: the input is to blame where a constraint is not met all nodes of which are held.
void ShapeProjection::give_up(double left) const {
  int contradicted = 0;
  for (std::size_t k = 0; k < constraints_.size(); ++k)
    if (std::abs(values_[k]) > tolerance * constraints_[k].rest && is_held(k)) contradicted = 1;
  MPI_Allreduce(MPI_IN_PLACE, &contradicted, 1, MPI_INT, MPI_MAX, mesh_.comm);
  if (contradicted != 0)
    throw UserError(
        "filter.constraints: 'paper' keeps lengths in filtered elements that contradict the nodes that are "
        "held "
        "there; 'compliant' and 'none' keep none");
  throw SimulationError(formatted(
      "the lengths that filter.constraints: paper keeps contradict each other, or the step is too large: "
      "after %d iterations one is off by %.2g of itself; filter.constraints: compliant keeps none",
      most_iterations, left));
}

int ShapeProjection::project(NodeField& x, NodeField& v, std::span<const NodeConstraint> held, double dt) {
  const PhaseScope phase(Phase::filter);
  std::ranges::copy(x.owned(), before_.owned().begin());
  double left = take_violations(x);
  int iterations = 0;
  const int most = sweeps_ > 0 ? sweeps_ : most_iterations;
  for (; left > tolerance && iterations < most; ++iterations) {
    if (form_ == FilterProjection::goldenthal) set_rows(x);
    const auto of_rows = std::span(values_).first(rows_->size());
    rows_->factor(held);
    rows_->solve(of_rows);
    rows_->take_off(of_rows, held, x);
    left = take_violations(x);
  }
  const double allowed = sweeps_ > 0 ? std::numeric_limits<double>::max() : tolerance;
  if (!(left <= allowed)) give_up(left);
  for (std::size_t i = 0; i < x.owned().size(); ++i) v.owned()[i] += (x.owned()[i] - before_.owned()[i]) / dt;
  v.touched();
  return iterations;
}

}  // namespace evert
