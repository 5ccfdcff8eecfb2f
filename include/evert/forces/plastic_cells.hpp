#pragma once
#include "evert/core/aligned.hpp"
#include "evert/elements/element_block.hpp"
#include "evert/forces/kernels/cell_batch.hpp"
#include "evert/materials/plasticity.hpp"

#include <cstddef>
#include <span>

namespace evert {

/// What the points of a block remember of their flow: F_p, α and the work on it. Holds the shape data at
/// rest; those of the block itself become those of F_p⁻¹ (kernels/plastic_flow.hpp). Knows no MPI; allocates
/// nothing after it was made.
class PlasticCells {
 public:
  /// Of a block in double, whose shape data are those at rest and which outlives it: nothing has flown.
  PlasticCells(const Plasticity& law, ElementBlock& block);

  [[nodiscard]] const Plasticity& law() const { return arrays_.law; }
  /// The time between the last update of the forces and the next one [s]; 0 unless told otherwise.
  void set_elapsed(double dt);

  /// Of one cell, as in ElementBlock::cell_of_lane: α as equivalent plastic strain in tension, and det F_p;
  /// the mean over its volume at rest. Work on its flow [J], ≥ 0.
  [[nodiscard]] double equivalent_strain(LocalIndex cell) const;
  [[nodiscard]] double volume_ratio(LocalIndex cell) const;
  /// Of all cells [J].
  [[nodiscard]] double work() const;

  /// Numbers that a cell remembers, and these; they mean the same in any block of the same cell, so that they
  /// can be kept and brought back bit by bit.
  [[nodiscard]] std::size_t numbers_per_cell() const;
  void get(LocalIndex cell, std::span<double> numbers) const;
  void set(LocalIndex cell, std::span<const double> numbers);

  /// By how much rest stiffness may have grown in a batch since it was last settled, see settle(): Σ Δα.
  [[nodiscard]] std::span<const float> drift() const { return drift_; }
  void settle(LocalIndex batch) { drift_[static_cast<std::size_t>(batch)] = 0; }
  /// The rotation R of F_p = R S as it is kept, S symmetric, of the cell in lane number `slot`: Rᵀ turns its
  /// shape data to those of S⁻¹, which points of one cell have in common.
  [[nodiscard]] Mat3d rotation(std::size_t slot, std::size_t q) const;
  /// F_p⁻¹ of det > 0, symmetric, at point `q` of a cell.
  [[nodiscard]] Mat3d inverse_stretch(LocalIndex cell, std::size_t q) const;

  [[nodiscard]] const kernels::PlasticArrays* arrays() const { return &arrays_; }
  [[nodiscard]] std::size_t memory() const;

 private:
  [[nodiscard]] std::size_t index(std::size_t slot, std::size_t q, std::size_t number) const;
  [[nodiscard]] std::size_t slot_of(LocalIndex cell) const;
  [[nodiscard]] Mat3d deformation(std::size_t slot, std::size_t q) const;
  /// The mean of `value_of(q)` over a cell's volume at rest.
  template <class ValueOf>
  [[nodiscard]] double mean(std::size_t slot, ValueOf&& value_of) const;
  void set_shapes(std::size_t slot, std::size_t q);

  ElementBlock& block_;
  ShapeLayout layout_;
  AlignedVector<double> rest_shapes_, state_;
  AlignedVector<float> drift_;
  std::vector<LocalIndex> slot_of_cell_;
  kernels::PlasticArrays arrays_;
};

}  // namespace evert
