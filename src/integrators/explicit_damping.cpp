#include "evert/integrators/explicit_damping.hpp"

#include "evert/elements/reference_element.hpp"
#include "evert/elements/rest_shape.hpp"
#include "evert/math/eigen_symmetric3.hpp"
#include "evert/math/nodal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace evert {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// λmax of damping against elasticity at rest [s]: as quadratic forms in the strain they have common
/// directions, the five of changing shape and the one of changing volume.
double damping_time(const Damping& damping, const Lame& lame) {
  return std::max(damping.beta / lame.mu,
                  (2 * damping.beta + 3 * damping.alpha) / (2 * lame.mu + 3 * lame.lambda));
}

/// max(1, σ1²) over the points of a block: the models that damp the rate of Green's strain grow with the
/// square of the stretch.
double largest_squared_stretch(const ElasticBlock& block, std::span<const Vec3d> rest_positions,
                               const NodeField& x) {
  double largest = 1;
  with_reference_element(block.type(), [&](const auto& element) {
    const auto nodes = static_cast<std::size_t>(element.nodes);
    for (LocalIndex c = 0; c < block.cells(); ++c) {
      const auto numbers = block.cell_nodes(c);
      const std::span<const LocalIndex> cell(numbers.begin(), nodes);
      for (std::size_t q = 0; q < static_cast<std::size_t>(element.points); ++q) {
        const Mat3d to_reference = inverse(rest_jacobian(element, q, cell, rest_positions));
        Mat3d f{};
        for (std::size_t a = 0; a < nodes; ++a)
          f += outer(node_value(x.local(), cell[a]), transpose_times(to_reference, element.gradients[q][a]));
        largest = std::max(largest, eigen_symmetric3(transpose_times(f, f)).values[2]);
      }
    }
  });
  return largest;
}

Lame moduli_of(const ElasticBlock& block) {
  return std::visit([](const auto& model) { return model.lame; }, block.material());
}

bool is_soft_but_damped(const ElasticBlock& block) { return block.damped() && !(moduli_of(block).mu > 0); }

/// Damping that is not of the strains that a filter has lowered, once these are mixed with others: that of
/// separate cells with models that damp the rate of Green's strain.
bool escapes_filter(const ElasticForces& elastic, std::size_t block) {
  return elastic.entry_of(block) != block && elastic.blocks()[block]->damped() &&
         elastic.blocks()[block]->damping().model != DampingModel::rotated;
}

/// λmax(M⁻¹C) from the diagonal blocks of C alone, n of which, n the nodes of a cell, are above C: for cells
/// whose elasticity is no measure of it.
double rate_from_diagonal(const System& system) {
  NodeField normal(system.mesh), shear(system.mesh);
  system.elastic.damping_diagonal(normal, shear);
  int nodes_a_cell = 0;
  for (const auto& cells : system.mesh.cells) nodes_a_cell = std::max(nodes_a_cell, node_count(cells.type));
  double largest = 0;
  for (LocalIndex node = 0; node < system.mesh.owned_nodes; ++node) {
    const Vec3d n = node_value(normal.owned(), node), s = node_value(shear.owned(), node);
    const Mat3d block{Vec3d{n[0], s[2], s[1]}, Vec3d{s[2], n[1], s[0]}, Vec3d{s[1], s[0], n[2]}};
    largest = std::max(largest,
                       eigen_symmetric3(block).values[2] / system.masses()[static_cast<std::size_t>(node)]);
  }
  return nodes_a_cell * largest;
}

double mass_damping_rate(const System& system) {
  double largest = 0;
  const auto damping = system.elastic.mass_damping();
  for (std::size_t node = 0; node < damping.size(); ++node)
    largest = std::max(largest, damping[node] / system.masses()[node]);
  return largest;
}

double step_of(double rate, double frequency) {
  const double denominator = rate + std::sqrt(rate * rate + 4 * frequency * frequency);
  return denominator > 0 ? 4 / denominator : unbounded;
}

}  // namespace

void damped_force(const System& system, NodeField& v, NodeField& force) {
  std::copy(system.f.owned().begin(), system.f.owned().end(), force.owned().begin());
  force.touched();
  if (system.elastic.damped()) system.elastic.add_damping(v, force, -1);
}

double explicitly_damped_step(const System& system) {
  const auto& mesh = system.mesh;
  const auto blocks = system.elastic.blocks();
  std::array<double, 2> rates{mass_damping_rate(system), 0};
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (blocks[b] != nullptr && (is_soft_but_damped(*blocks[b]) || escapes_filter(system.elastic, b)))
      rates[1] = 1;
  MPI_Allreduce(MPI_IN_PLACE, rates.data(), 2, MPI_DOUBLE, MPI_MAX, mesh.comm);
  const bool by_diagonal = rates[1] > 0;
  const double common = by_diagonal ? rate_from_diagonal(system) : rates[0];
  double step = step_of(common, 0);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (blocks[b] == nullptr) continue;
    const double frequency = 2 / blocks[b]->stable_step(system.x.local().data()).undamped;
    double rate = common;
    if (!by_diagonal && blocks[b]->damped() && frequency > 0) {
      const auto& damping = blocks[b]->damping();
      const double stretch = damping.model == DampingModel::rotated
                                 ? 1
                                 : largest_squared_stretch(*blocks[b], mesh.rest_positions, system.x);
      rate += damping_time(damping, moduli_of(*blocks[b])) * stretch * frequency * frequency;
    }
    step = std::min(step, step_of(rate, frequency));
  }
  return step;
}

}  // namespace evert
