#pragma once
#include "evert/elements/element_block.hpp"
#include "evert/forces/kernels/shape_gradients.hpp"
#include "evert/materials/material.hpp"
#include "evert/materials/plasticity.hpp"

#include <cstddef>
#include <variant>

namespace evert::kernels {

/// Of a block that flows; what its update changes.
struct PlasticArrays {
  Plasticity law;
  double dt = 0;                        ///< since the last update [s]
  const double* rest_shapes = nullptr;  ///< BlockArrays::shapes without flow
  double* shapes = nullptr;             ///< BlockArrays::shapes: those of F_p⁻¹
  double* state = nullptr;              ///< [batch][point] of plastic_numbers [lane], see plastic_flow.hpp
  const double* goal = nullptr;  ///< [batch][point] of goal_numbers [lane]; null where no control is in force
  double attraction = 0;         ///< what log F_p goes of its way to the goal by itself, in [0, 1)
  float* drift = nullptr;  ///< [batch][lane] Σ of the largest Δα of a cell's points since it was last cleared
};

/// The arrays of an ElementBlock and what goes with it, as the kernels see them. `void` stands for the scalar
/// of the kernels that the block was made for, double or float.
struct BlockArrays {
  const LocalIndex* nodes;         ///< [batch][node][lane]
  const void* shapes;              ///< [batch] of RestGradients::numbers
  const void* volumes;             ///< [batch][point][lane]
  const LocalIndex* cell_of_lane;  ///< [batch][lane]
  const float* rest_stiffness;     ///< [batch][lane] λ_e of the stable step, see tangent_bound.hpp [1/s²]
  const float* spin_stiffness;     ///< the same for damped spin, see stable_steps [1/s²]
  void* damping_state;             ///< see damping_kernels.hpp
  const void* fibres;              ///< [batch][point][3][lane]; null where the model has none
  const PlasticArrays* plastic;    ///< null where nothing flows
  bool mean_dilatation;            ///< of models with a dilatation, in cells of several points
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
  RestGradients<T, element> shape;
  const scalar_t<T>* volumes;

  EVERT_ALWAYS_INLINE CellBatch(const BlockArrays& block, LocalIndex batch)
      : nodes(block.nodes + static_cast<std::size_t>(batch) * element.nodes * lanes),
        shape{{static_cast<const scalar_t<T>*>(block.shapes) +
               static_cast<std::size_t>(batch) * points * decltype(shape)::layout.numbers() * lanes}},
        volumes(static_cast<const scalar_t<T>*>(block.volumes) +
                static_cast<std::size_t>(batch) * points * lanes) {}

  /// |∂X/∂ξ| W at point q.
  EVERT_ALWAYS_INLINE T volume(std::size_t q) const { return load<T>(volumes + q * lanes); }

  /// Differences of a nodal field to each cell's first node.
  EVERT_ALWAYS_INLINE auto edges_of(const double* field) const {
    return gather_edges<T, nodes_per_cell>(field, nodes);
  }
};

}  // namespace evert::kernels
