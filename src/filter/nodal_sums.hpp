#pragma once
#include "evert/filter/selection.hpp"

namespace evert {

/// Up to three numbers a node, which the cells of all ranks add to.
class NodalSums {
 public:
  /// Collective. All zero.
  explicit NodalSums(const FilterProblem& problem) : halo_(problem.elastic.halo()), field_(problem.mesh) {}

  [[nodiscard]] double& at(LocalIndex node, std::size_t k) {
    return field_.local()[3 * static_cast<std::size_t>(node) + k];
  }
  [[nodiscard]] double at(LocalIndex node, std::size_t k) const {
    return field_.local()[3 * static_cast<std::size_t>(node) + k];
  }
  /// Collective. From what each rank has added to the sums of all, ghosts included.
  void share() {
    halo_.begin_add(field_);
    halo_.end_add(field_);
    field_.touched();
    send_to_ghosts();
  }
  /// Collective. Values of owned nodes to their ghosts.
  void send_to_ghosts() {
    field_.touched();
    halo_.begin_update(field_);
    halo_.end_update(field_);
  }

 private:
  const Halo& halo_;
  NodeField field_;
};

/// M̃_e: all the mass of its nodes.
[[nodiscard]] inline TetMasses masses_of_nodes(const FilterProblem& problem, const FilterCell& cell) {
  TetMasses masses{};
  for (std::size_t a = 0; a < 4; ++a) masses[a] = problem.masses[static_cast<std::size_t>(cell.nodes[a])];
  return masses;
}

}  // namespace evert
