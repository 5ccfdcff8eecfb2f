#pragma once
#include "evert/elements/element_block.hpp"
#include "evert/elements/reference_element.hpp"
#include "evert/forces/kernels/node_access.hpp"
#include "evert/materials/material.hpp"

#include <cstddef>
#include <variant>

namespace evert::kernels {

/// The arrays of an ElementBlock and what goes with it, as the kernels see them.
struct BlockArrays {
  const LocalIndex* nodes;         ///< [batch][node][lane]
  const double* gradients;         ///< [batch][point][node 1…][3][lane]
  const double* volumes;           ///< [batch][point][lane]
  const LocalIndex* cell_of_lane;  ///< [batch][lane]
  const double* rest_stiffness;    ///< [batch][lane] λ_e of the stable step, see tangent_bound.hpp [1/s²]
  const double* spin_stiffness;    ///< the same for damped spin, see stable_steps [1/s²]
  double* damping_state;           ///< see damping_kernels.hpp
};

/// The model that the kernel was chosen by.
template <class Model>
EVERT_ALWAYS_INLINE Model model_of(const Material& material) {
  const Model* model = std::get_if<Model>(&material);
  if (model == nullptr) __builtin_unreachable();
  return *model;
}

/// One batch of a block: a cell per lane of T.
template <Real T, const auto& element>
struct CellBatch {
  static constexpr std::size_t lanes = lanes_v<T>;
  static constexpr int nodes_per_cell = element.nodes;
  static constexpr std::size_t points = element.points;

  const LocalIndex* nodes;
  const double* gradients;
  const double* volumes;

  EVERT_ALWAYS_INLINE CellBatch(const BlockArrays& block, LocalIndex batch)
      : nodes(block.nodes + static_cast<std::size_t>(batch) * element.nodes * lanes),
        gradients(block.gradients +
                  static_cast<std::size_t>(batch) * points * (element.nodes - 1) * 3 * lanes),
        volumes(block.volumes + static_cast<std::size_t>(batch) * points * lanes) {}

  /// ∂N_a/∂X at point q, for a ≥ 1.
  EVERT_ALWAYS_INLINE Vec3<T> gradient(std::size_t q, std::size_t a) const {
    const double* of_node = gradients + (q * (element.nodes - 1) + a - 1) * 3 * lanes;
    return {load<T>(of_node), load<T>(of_node + lanes), load<T>(of_node + 2 * lanes)};
  }

  /// |∂X/∂ξ| W at point q.
  EVERT_ALWAYS_INLINE T volume(std::size_t q) const { return load<T>(volumes + q * lanes); }

  /// Differences of a nodal field to each cell's first node.
  EVERT_ALWAYS_INLINE auto edges_of(const double* field) const {
    return gather_edges<T, nodes_per_cell>(field, nodes);
  }

  /// Gradient of a nodal field at point q: F of positions, Ḟ of velocities.  paper A, section 4: F = D_s H
  /// (D_m H)⁻¹
  EVERT_ALWAYS_INLINE Mat3<T> field_gradient(const Edges<T, nodes_per_cell>& edges, std::size_t q) const {
    Mat3<T> sum = outer(edges[0], gradient(q, 1));
    for (std::size_t a = 2; a < nodes_per_cell; ++a) sum += outer(edges[a - 1], gradient(q, a));
    return sum;
  }

  /// Σ_q P_q ∂N_a/∂X for every node but the first, with `stress_at(q)` = |∂X/∂ξ| W P_q: the blocks G = Σ P
  /// B_m of paper A, section 4.
  template <class StressAt>
  EVERT_ALWAYS_INLINE Edges<T, nodes_per_cell> nodal_sums(StressAt&& stress_at) const {
    Edges<T, nodes_per_cell> sums;
    const Mat3<T> first = stress_at(0);
    for (std::size_t a = 1; a < nodes_per_cell; ++a) sums[a - 1] = first * gradient(0, a);
    for (std::size_t q = 1; q < points; ++q) {
      const Mat3<T> stress = stress_at(q);
      for (std::size_t a = 1; a < nodes_per_cell; ++a) sums[a - 1] += stress * gradient(q, a);
    }
    return sums;
  }
};

}  // namespace evert::kernels
