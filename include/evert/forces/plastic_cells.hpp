#pragma once
#include "evert/core/aligned.hpp"
#include "evert/elements/element_block.hpp"
#include "evert/forces/kernels/cell_batch.hpp"
#include "evert/materials/plasticity.hpp"
#include "evert/math/lower_triangle.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace evert {

/// What the points of a block remember of their flow: F_p, α and the work on it. Holds the shape data at
/// rest; those of the block itself become those of F_p⁻¹ (kernels/plastic_flow.hpp). Knows no MPI; allocates
/// nothing after it was made.
class PlasticCells {
 public:
  using DeformShapes = void (*)(const kernels::PlasticArrays&, BatchRange);
  /// Of a block in double, whose shape data are those at rest and which outlives it: nothing has flown.
  PlasticCells(const Plasticity& law, ElementBlock& block, DeformShapes deform_shapes);

  [[nodiscard]] const Plasticity& law() const { return arrays_.law; }
  void set_law(const Plasticity& law);
  /// The times of the last update of the forces and of the next one [s]. The same unless told otherwise, and
  /// then nothing flows.
  void set_times(double last, double next);
  /// From now on flow is controlled. The goal of a point is the deformation that brings the nodes of its cell
  /// to `position(cell, node of the cell)` [m], without its rotation. Returns the cells, ascending, whose
  /// goal is inverted or flat, or stretches them beyond the limit of the law: then nothing is controlled.
  using GoalPosition = std::function<Vec3d(LocalIndex cell, std::size_t node)>;
  [[nodiscard]] std::vector<LocalIndex> set_goal(const PlasticControl& control, const GoalPosition& position);
  /// ∫‖log S − log S of the goal‖² dV over the volume at rest [m³]; 0 without a control.
  [[nodiscard]] double square_distance_to_goal() const;
  /// ∫‖log S of the goal‖² dV [m³]: what it was at the start.
  [[nodiscard]] double square_of_goal() const;

  /// Of one cell, as in ElementBlock::cell_of_lane: α as equivalent plastic strain in tension, and det F_p;
  /// the mean over its volume at rest. Work on its flow [J], ≥ 0.
  [[nodiscard]] double equivalent_strain(LocalIndex cell) const;
  [[nodiscard]] double volume_ratio(LocalIndex cell) const;
  /// Of all cells [J]; that of the control, of either sign, apart.
  [[nodiscard]] double work() const { return sum(7); }
  [[nodiscard]] double control_work() const { return sum(8); }

  /// Numbers that a cell remembers, and these; they mean the same in any block of the same cell, so that they
  /// can be kept and brought back bit by bit.
  static constexpr std::size_t numbers_per_point = 9;
  static constexpr std::size_t numbers_besides = 3;
  [[nodiscard]] std::size_t numbers_per_cell() const;
  void get(LocalIndex cell, std::span<double> numbers) const;
  void set(LocalIndex cell, std::span<const double> numbers);

  /// The rest stiffness that a cell had when it was last computed, in lane number `slot`, and the way that
  /// log F_p has gone since; part of what it remembers, so that a restart has the same steps.
  struct Stiffness {
    float largest, spin;  ///< as RestStiffness [1/s²]
    float drift;          ///< Σ of the largest Δα of its points
  };
  [[nodiscard]] Stiffness stiffness(std::size_t slot) const {
    return {settled_largest_[slot], settled_spin_[slot], drift_[slot]};
  }
  void settle(std::size_t slot, float largest, float spin);
  /// The way that log F_p of a cell has gone at most, at any of its points, since it was last set.
  [[nodiscard]] double way(LocalIndex cell) const;
  void set_way(LocalIndex cell, double way);
  /// True where some cell has gone farther than it may; none has a bound until one is set.
  [[nodiscard]] bool is_beyond_bounds() const;
  /// How long the way of a cell may become.
  void bound_way(LocalIndex cell, double most);
  /// ∂N_a/∂X [1/m] of the nodes of a cell at its first point, in the shape that has flown; but for a rotation
  /// that they have in common.
  void shape_gradients(LocalIndex cell, std::span<Vec3d> gradients) const;
  /// Gives the block its shape data as it was made, and takes them back when called again.
  void exchange_shapes();
  /// The rotation R of F_p = R S as it is kept, S symmetric, of the cell in lane number `slot`: Rᵀ turns its
  /// shape data to those of S⁻¹, which points of one cell have in common.
  [[nodiscard]] Mat3d rotation(std::size_t slot, std::size_t q) const;

  [[nodiscard]] const kernels::PlasticArrays* arrays() const { return &arrays_; }
  [[nodiscard]] std::size_t memory() const;

 private:
  /// Where number `number` of `numbers` a point stands.
  [[nodiscard]] std::size_t index(std::size_t slot, std::size_t q, std::size_t number,
                                  std::size_t numbers) const;
  [[nodiscard]] std::size_t index(std::size_t slot, std::size_t q, std::size_t number) const;
  [[nodiscard]] std::size_t slot_of(LocalIndex cell) const;
  [[nodiscard]] double largest_alpha(LocalIndex cell) const;
  [[nodiscard]] LowerTriangle<double> deformation(std::size_t slot, std::size_t q) const;
  /// ∫ of a number over the volume at rest.
  [[nodiscard]] double sum(std::size_t number) const;
  /// The mean of `value_of(q)` over a cell's volume at rest.
  template <class ValueOf>
  [[nodiscard]] double mean(std::size_t slot, ValueOf&& value_of) const;
  [[nodiscard]] double volume(std::size_t slot, std::size_t q) const;
  [[nodiscard]] std::size_t goal_index(std::size_t slot, std::size_t q, std::size_t number) const;
  [[nodiscard]] Mat3d goal(std::size_t slot, std::size_t q) const;

  ElementBlock& block_;
  DeformShapes deform_shapes_;
  AlignedVector<double> rest_shapes_, state_;
  AlignedVector<double> goal_;  // [batch][point] of goal_numbers [lane], where there is a control
  PlasticControl control_;
  AlignedVector<float> drift_, settled_largest_, settled_spin_;  // [batch][lane]
  std::vector<double> way_from_, way_until_;                     // α where it begins, and may end, per cell
  std::vector<LocalIndex> slot_of_cell_;
  kernels::PlasticArrays arrays_;
};

}  // namespace evert
