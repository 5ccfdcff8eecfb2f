#include "evert/forces/plastic_cells.hpp"

#include "evert/core/error.hpp"
#include "evert/forces/kernels/plastic_flow.hpp"
#include "evert/math/lower_triangle.hpp"
#include "evert/math/svd3.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace evert {

using kernels::plastic_numbers;

PlasticCells::PlasticCells(const Plasticity& law, ElementBlock& block)
    : block_(block),
      layout_(rest_layout(block.shape_data, block.element.nodes(), block.element.points())),
      rest_shapes_(block.shapes.size()),
      state_(block.cell_of_lane.size() * block.element.points() * plastic_numbers),
      drift_(static_cast<std::size_t>(block.batches())),
      slot_of_cell_(static_cast<std::size_t>(block.cells)) {
  for (std::size_t i = 0; i < rest_shapes_.size(); ++i) rest_shapes_[i] = block.shapes[i];
  for (std::size_t slot = 0; slot < block.cell_of_lane.size(); ++slot) {
    if (block.cell_of_lane[slot] >= 0)
      slot_of_cell_[static_cast<std::size_t>(block.cell_of_lane[slot])] = static_cast<LocalIndex>(slot);
    for (std::size_t q = 0; q < block.element.points(); ++q)
      for (const std::size_t diagonal : {0, 2, 5}) state_[index(slot, q, diagonal)] = 1;
  }
  arrays_ = {law,          0, rest_shapes_.data(), static_cast<double*>(block.shapes.data()), state_.data(),
             drift_.data()};
}

void PlasticCells::set_elapsed(double dt) { arrays_.dt = dt; }

std::size_t PlasticCells::index(std::size_t slot, std::size_t q, std::size_t number) const {
  const auto lanes = static_cast<std::size_t>(block_.lanes);
  const std::size_t point = slot / lanes * block_.element.points() + q;
  return (point * plastic_numbers + number) * lanes + slot % lanes;
}

std::size_t PlasticCells::slot_of(LocalIndex cell) const {
  return static_cast<std::size_t>(slot_of_cell_[static_cast<std::size_t>(cell)]);
}

Mat3d PlasticCells::deformation(std::size_t slot, std::size_t q) const {
  const auto number = [&](std::size_t i) { return state_[index(slot, q, i)]; };
  return matrix(LowerTriangle<double>{number(0), number(1), number(2), number(3), number(4), number(5)});
}

template <class ValueOf>
double PlasticCells::mean(std::size_t slot, ValueOf&& value_of) const {
  const auto lanes = static_cast<std::size_t>(block_.lanes);
  const std::size_t points = block_.element.points();
  double sum = 0, volume = 0;
  for (std::size_t q = 0; q < points; ++q) {
    const double of_point = block_.volumes[(slot / lanes * points + q) * lanes + slot % lanes];
    sum += of_point * value_of(q);
    volume += of_point;
  }
  return sum / volume;
}

double PlasticCells::equivalent_strain(LocalIndex cell) const {
  const auto slot = slot_of(cell);
  return Plasticity::equivalent_strain(mean(slot, [&](std::size_t q) { return state_[index(slot, q, 6)]; }));
}

double PlasticCells::volume_ratio(LocalIndex cell) const {
  const auto slot = slot_of(cell);
  return mean(slot, [&](std::size_t q) { return determinant(deformation(slot, q)); });
}

double PlasticCells::work() const {
  const auto lanes = static_cast<std::size_t>(block_.lanes);
  const std::size_t points = block_.element.points();
  double sum = 0;
  for (std::size_t slot = 0; slot < block_.cell_of_lane.size(); ++slot)
    for (std::size_t q = 0; q < points; ++q)
      sum += block_.volumes[(slot / lanes * points + q) * lanes + slot % lanes] * state_[index(slot, q, 7)];
  return sum;
}

std::size_t PlasticCells::numbers_per_cell() const { return block_.element.points() * plastic_numbers; }

void PlasticCells::get(LocalIndex cell, std::span<double> numbers) const {
  EVERT_ASSERT(numbers.size() == numbers_per_cell(), std::to_string(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = state_[index(slot_of(cell), i / plastic_numbers, i % plastic_numbers)];
}

void PlasticCells::set(LocalIndex cell, std::span<const double> numbers) {
  EVERT_ASSERT(numbers.size() == numbers_per_cell(), std::to_string(numbers.size()));
  const auto slot = slot_of(cell);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    state_[index(slot, i / plastic_numbers, i % plastic_numbers)] = numbers[i];
  for (std::size_t q = 0; q < block_.element.points(); ++q) set_shapes(slot, q);
  constexpr float unsettled = 1e3F;
  drift_[slot / static_cast<std::size_t>(block_.lanes)] = unsettled;
}

/// As keep_deformation() of plastic_flow.hpp, number by number.
void PlasticCells::set_shapes(std::size_t slot, std::size_t q) {
  const auto number = [&](std::size_t i) { return state_[index(slot, q, i)]; };
  const auto l =
      inverse(LowerTriangle<double>{number(0), number(1), number(2), number(3), number(4), number(5)});
  const auto lanes = static_cast<std::size_t>(block_.lanes);
  const std::size_t first =
      (slot / lanes * block_.element.points() + q) * layout_.numbers() * lanes + slot % lanes;
  for (std::size_t j = 0; j < layout_.vectors; ++j) {
    const auto at = [&](std::size_t k) { return first + (layout_.begin(j) + k) * lanes; };
    Vec3d v{0, 0, 0};
    for (std::size_t k = 0; k < layout_.components(j); ++k) v[k] = rest_shapes_[at(k)];
    const Vec3d flown = kernels::times_inverse(v, l);
    for (std::size_t k = 0; k < layout_.components(j); ++k) arrays_.shapes[at(k)] = flown[k];
  }
}

Mat3d PlasticCells::rotation(std::size_t slot, std::size_t q) const {
  return polar_rotation(deflate(deformation(slot, q)));
}

Mat3d PlasticCells::inverse_stretch(LocalIndex cell, std::size_t q) const {
  const auto svd = svd3(deformation(slot_of(cell), q));
  const Vec3d inverse{1 / svd.sigma[0], 1 / svd.sigma[1], 1 / svd.sigma[2]};
  return times_transpose(svd.v * diagonal(inverse), svd.v);
}

std::size_t PlasticCells::memory() const {
  return (rest_shapes_.capacity() + state_.capacity()) * sizeof(double) + drift_.capacity() * sizeof(float) +
         slot_of_cell_.capacity() * sizeof(LocalIndex);
}

}  // namespace evert
