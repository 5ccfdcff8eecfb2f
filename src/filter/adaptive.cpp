#include "adaptive.hpp"

#include "evert/filter/collatz_wielandt.hpp"
#include "evert/filter/spectrum.hpp"

#include "nodal_sums.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace evert {
namespace {

// Found by trying on ball20k at ten times its step: lowering more cells at a time needs fewer rounds and
// filters up to a fifth more of them.
constexpr double step_down = 0.8;  // of a cell's limit in one round
constexpr double top_share = 0.6;  // of what the cell that has most has
// Cells that are slow enough for their own mass are left alone as long as others have a tenth of what they
// have: softening the others alone is enough by eq. (9), though not always for the bound of Collatz and
// Wielandt.
constexpr double share_of_slow = 0.1;
constexpr double tie = 1e-6;          // shares this close are equal, whatever the ranks' rounding
constexpr int lanczos_steps = 60;     // finds tens of the fastest modes in a round
constexpr int power_iterations = 60;  // settles where the bound is largest

double largest_over_ranks(MPI_Comm comm, double value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, comm);
  return value;
}

/// The body with the filters of the moment.
class Trial {
 public:
  Trial(const FilterProblem& problem, double limit, const std::vector<bool>& changed, CellClamps& clamps)
      : problem_(problem),
        limit_(limit),
        clamps_(clamps),
        stiffness_(problem.mesh, problem.elastic),
        against_all_mass_(eigenvalues_against_all_mass(problem)),
        filters_(problem.cells.size()),
        slow_(problem.cells.size()),
        marked_(problem.cells.size()) {
    for (std::size_t c = 0; c < slow_.size(); ++c) {
      const auto& cell = problem.cells[c];
      slow_[c] = element_modes(cell.shape, cell.own_masses(), cell.lame).largest() <= limit;
    }
    for (std::size_t c = 0; c < clamps_.size(); ++c)
      set_limit(c, changed[c] ? std::min(limit, against_all_mass_[c]) : level_of(c));
  }

  /// Collective. One round against the modes above the limit; false when Lanczos finds none.
  bool lower_fast_modes() {
    assemble();
    const auto modes = modes_above(stiffness_, limit_, lanczos_steps);
    std::fill(marked_.begin(), marked_.end(), false);
    for (const auto& mode : modes) {
      auto u = over_root_masses(mode.scaled.get(), 3);
      mark_top([&](std::size_t c) { return energy(c, u); });
    }
    lower_marked();
    return !modes.empty();
  }

  /// Collective. One round where the bound of Collatz and Wielandt is largest; false when it keeps the limit.
  bool lower_bound() {
    assemble();
    if (collatz_wielandt_bound(stiffness_.mat()) <= limit_) return false;
    const auto [bound, weights] = collatz_wielandt(stiffness_.mat(), power_iterations);
    if (bound <= limit_) return false;
    std::fill(marked_.begin(), marked_.end(), false);
    auto x = over_root_masses(weights.get(), 1);
    mark_top([&](std::size_t c) { return weighted_norms(c, x); });
    lower_marked();
    return true;
  }

 private:
  /// The limit of the cell by itself, or its eigenvalue where that is lower.
  [[nodiscard]] double level_of(std::size_t c) const {
    return clamps_[c].limit > 0 ? std::min(clamps_[c].limit, against_all_mass_[c]) : against_all_mass_[c];
  }

  void set_limit(std::size_t c, double limit) {
    const auto& cell = problem_.cells[c];
    const auto masses = masses_of_nodes(problem_, cell);
    clamps_[c] = against_all_mass_[c] > limit ? CellClamp{masses, limit} : CellClamp{};
    filters_[c] = strain_filter(element_modes(cell.shape, masses, cell.lame), cell.lame, limit);
  }

  /// Collective.
  void assemble() {
    stiffness_.assemble([&](NodeMatrix& matrix) {
      CellNodes nodes(4);
      for (std::size_t c = 0; c < problem_.cells.size(); ++c) {
        std::copy(problem_.cells[c].nodes.begin(), problem_.cells[c].nodes.end(), &nodes[0]);
        matrix.add(nodes, stiffness_of(c));
      }
    });
  }

  [[nodiscard]] TetMatrix stiffness_of(std::size_t c) const {
    const auto& cell = problem_.cells[c];
    return clamps_[c].limit > 0 ? element_stiffness(cell.shape, cell.lame, filters_[c])
                                : element_stiffness(cell.shape, cell.lame);
  }

  /// Collective. Values of a vector of 3 (displacements) or 1 (weights) a node, over √m, ghosts included.
  [[nodiscard]] NodalSums over_root_masses(Vec values, std::size_t per_node) const {
    NodalSums nodal(problem_);
    const PetscScalar* of_owned = nullptr;
    check(VecGetArrayRead(values, &of_owned));
    for (LocalIndex node = 0; node < problem_.mesh.owned_nodes; ++node)
      for (std::size_t k = 0; k < per_node; ++k)
        nodal.at(node, k) = of_owned[per_node * static_cast<std::size_t>(node) + k] /
                            std::sqrt(problem_.masses[static_cast<std::size_t>(node)]);
    check(VecRestoreArrayRead(values, &of_owned));
    nodal.send_to_ghosts();
    return nodal;
  }

  /// u_eᵀ K'_e u_e
  [[nodiscard]] double energy(std::size_t c, NodalSums& u) const {
    const auto& [nodes, shape, density, lame] = problem_.cells[c];
    const auto at = [&](std::size_t a) {
      return Vec3d{u.at(nodes[a], 0), u.at(nodes[a], 1), u.at(nodes[a], 2)};
    };
    Mat3d gradient{};
    for (std::size_t a = 1; a < 4; ++a) gradient += outer(at(a) - at(0), shape.gradients[a]);
    const Mat3d& axes = filters_[c].axes;
    const Mat3d turned = transpose_times(axes, gradient * axes);
    const Mat3d strain = filters_[c](0.5 * (turned + transpose(turned)));
    return shape.volume *
           (2 * lame.mu * contract(strain, strain) + lame.lambda * trace(strain) * trace(strain));
  }

  /// What the cell has of the sum over all blocks ‖K'_ab‖ x_a x_b.
  [[nodiscard]] double weighted_norms(std::size_t c, NodalSums& x) const {
    const auto& nodes = problem_.cells[c].nodes;
    const TetMatrix k = stiffness_of(c);
    double sum = 0;
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b) {
        double square = 0;
        for (std::size_t i = 0; i < 9; ++i) {
          const double entry = k[12 * (3 * a + i / 3) + 3 * b + i % 3];
          square += entry * entry;
        }
        sum += std::sqrt(square) * x.at(nodes[a], 0) * x.at(nodes[b], 0);
      }
    return sum;
  }

  /// Collective. Marks the cells that have most of something.
  template <class Amount>
  void mark_top(Amount&& amount_of) {
    std::vector<double> amounts(problem_.cells.size());
    for (std::size_t c = 0; c < amounts.size(); ++c)
      amounts[c] = (slow_[c] ? share_of_slow : 1) * amount_of(c);
    const double most =
        largest_over_ranks(problem_.mesh.comm, amounts.empty() ? 0 : *std::ranges::max_element(amounts));
    for (std::size_t c = 0; c < amounts.size(); ++c)
      if (most > 0 && amounts[c] >= (top_share - tie) * most) marked_[c] = true;
  }

  void lower_marked() {
    for (std::size_t c = 0; c < marked_.size(); ++c)
      if (marked_[c]) set_limit(c, step_down * level_of(c));
  }

  const FilterProblem& problem_;
  double limit_;
  CellClamps& clamps_;
  MassScaledStiffness stiffness_;
  std::vector<double> against_all_mass_;
  std::vector<StrainFilter> filters_;
  std::vector<bool> slow_;  // against their own mass
  std::vector<bool> marked_;
};

}  // namespace

LocalIndex select_adaptive(const FilterProblem& problem, double limit, const std::vector<bool>& changed,
                           CellClamps& clamps) {
  Trial trial(problem, limit, changed, clamps);
  // Filters only soften, and so what one round has brought below the limit stays there.
  while (trial.lower_fast_modes()) {
  }
  while (trial.lower_bound()) {
  }
  return static_cast<LocalIndex>(problem.cells.size());
}

}  // namespace evert
