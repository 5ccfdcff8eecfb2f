#include "evert/integrators/shape_projection.hpp"

#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evert {
namespace {

constexpr double tolerance = 1e-6;       // of the length of a constraint
constexpr double regularisation = 1e-8;  // of the diagonal of S
constexpr int most_iterations = 30;

}  // namespace

ShapeProjection::ShapeProjection(const DistributedMesh& mesh, const ElasticForces& elastic,
                                 const ModalFilter& filter)
    : mesh_(mesh), elastic_(elastic), filter_(filter), before_(mesh) {
  NodeField inverse(mesh);
  for (std::size_t i = 0; i < inverse.owned().size(); ++i) inverse.owned()[i] = 1 / elastic.masses()[i / 3];
  inverse.touched();
  elastic.halo().begin_update(inverse);
  elastic.halo().end_update(inverse);
  for (std::size_t i = 0; i < inverse.local().size(); i += 3) inverse_masses_.push_back(inverse.local()[i]);
  rebuild();
}

void ShapeProjection::rebuild() {
  std::vector<RowSystem::Nodes> nodes;
  for (const auto& constraint : filter_.shape_constraints()) nodes.push_back(constraint.nodes);
  values_.resize(nodes.size());
  rows_.emplace(mesh_, elastic_, std::move(nodes));
  revision_ = filter_.revision();
}

/// J at `x`, and what S is regularised by.
void ShapeProjection::set_rows(const NodeField& x) {
  const auto& constraints = filter_.shape_constraints();
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    auto& row = rows_->coefficients()[k];
    static_cast<void>(violation(constraints[k], x.local(), row));
    double diagonal = 0;
    for (std::size_t a = 0; a < 4; ++a)
      if (constraints[k].nodes[a] >= 0)
        diagonal += inverse_masses_[static_cast<std::size_t>(constraints[k].nodes[a])] * dot(row[a], row[a]);
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
  const auto& constraints = filter_.shape_constraints();
  double largest = 0;
  TetRow gradient;
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    values_[k] = violation(constraints[k], std::as_const(x).local(), gradient);
    const double share = std::abs(values_[k]) / constraints[k].rest;
    largest = share <= largest ? largest : share;  // NaN is the largest
  }
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, mesh_.comm);
  return largest;
}

void ShapeProjection::begin(const NodeField& x) {
  if (revision_ != filter_.revision()) rebuild();
  if (filter_.options().projection == FilterProjection::shake) set_rows(x);
}

/// Whether all of the constraint's nodes are held in its directions.
bool ShapeProjection::is_held(std::size_t k) const {
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
  const auto& constraints = filter_.shape_constraints();
  int contradicted = 0;
  for (std::size_t k = 0; k < constraints.size(); ++k)
    if (std::abs(values_[k]) > tolerance * constraints[k].rest && is_held(k)) contradicted = 1;
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
  std::ranges::copy(x.owned(), before_.owned().begin());
  double left = take_violations(x);
  int iterations = 0;
  for (; left > tolerance && iterations < most_iterations; ++iterations) {
    if (filter_.options().projection == FilterProjection::goldenthal) set_rows(x);
    rows_->factor(held);
    rows_->solve(values_);
    rows_->take_off(values_, held, x);
    left = take_violations(x);
  }
  if (!(left <= tolerance)) give_up(left);
  for (std::size_t i = 0; i < x.owned().size(); ++i) v.owned()[i] += (x.owned()[i] - before_.owned()[i]) / dt;
  v.touched();
  return iterations;
}

}  // namespace evert
