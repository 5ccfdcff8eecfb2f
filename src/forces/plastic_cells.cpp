#include "evert/forces/plastic_cells.hpp"

#include "evert/core/error.hpp"
#include "evert/forces/kernels/plastic_flow.hpp"
#include "evert/math/lower_triangle.hpp"
#include "evert/math/svd3.hpp"

#include "rest_point.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace evert {

using kernels::goal_numbers;
using kernels::plastic_numbers;

static_assert(PlasticCells::numbers_per_point == plastic_numbers);

PlasticCells::PlasticCells(const Plasticity& law, ElementBlock& block, DeformShapes deform_shapes)
    : block_(block),
      deform_shapes_(deform_shapes),
      rest_shapes_(block.shapes.size()),
      state_(block.cell_of_lane.size() * block.element.points() * plastic_numbers),
      drift_(block.cell_of_lane.size()),
      settled_largest_(block.cell_of_lane.size()),
      settled_spin_(block.cell_of_lane.size()),
      way_from_(static_cast<std::size_t>(block.cells)),
      way_until_(static_cast<std::size_t>(block.cells), std::numeric_limits<double>::infinity()),
      slot_of_cell_(static_cast<std::size_t>(block.cells)) {
  for (std::size_t i = 0; i < rest_shapes_.size(); ++i) rest_shapes_[i] = block.shapes[i];
  for (std::size_t slot = 0; slot < block.cell_of_lane.size(); ++slot) {
    if (block.cell_of_lane[slot] >= 0)
      slot_of_cell_[static_cast<std::size_t>(block.cell_of_lane[slot])] = static_cast<LocalIndex>(slot);
    for (std::size_t q = 0; q < block.element.points(); ++q)
      for (const std::size_t diagonal : {0, 2, 5}) state_[index(slot, q, diagonal)] = 1;
  }
  arrays_ = {.law = law,
             .rest_shapes = rest_shapes_.data(),
             .shapes = static_cast<double*>(block.shapes.data()),
             .state = state_.data(),
             .drift = drift_.data()};
}

void PlasticCells::set_law(const Plasticity& law) { arrays_.law = law; }

void PlasticCells::set_times(double last, double next) {
  arrays_.dt = next - last;
  const bool controlled = !goal_.empty() && next > control_.from && next <= control_.until;
  arrays_.goal = controlled ? goal_.data() : nullptr;
  arrays_.attraction = controlled ? -std::expm1(-control_.strength * arrays_.dt) : 0;
}

std::vector<LocalIndex> PlasticCells::set_goal(const PlasticControl& control, const GoalPosition& position) {
  const std::size_t nodes = block_.element.nodes(), points = block_.element.points();
  const double most = std::log(arrays_.law.limit) * (1 + 1e-9);
  std::vector<LocalIndex> beyond;
  AlignedVector<double> goal(block_.cell_of_lane.size() * points * goal_numbers);
  for (LocalIndex cell = 0; cell < block_.cells; ++cell) {
    const auto slot = slot_of(cell);
    bool within = true;
    for (std::size_t q = 0; q < points; ++q) {
      const NodeVectors gradients = rest_point(block_, slot, q).gradients;  // nothing has flown yet
      Mat3d deformation{};
      for (std::size_t a = 0; a < nodes; ++a) deformation += outer(position(cell, a), gradients[a]);
      const auto svd = svd3(deformation);
      const Vec3d strain{std::log(svd.sigma[0]), std::log(svd.sigma[1]),
                         std::log(std::max(svd.sigma[2], 0.0))};
      within = within && std::abs(strain[0]) <= most && std::abs(strain[2]) <= most;
      const Mat3d log_stretch = times_transpose(svd.v * diagonal(strain), svd.v);
      for (std::size_t row = 0, i = 0; row < 3; ++row)
        for (std::size_t column = 0; column <= row; ++column, ++i)
          goal[goal_index(slot, q, i)] = log_stretch(row, column);
    }
    if (!within) beyond.push_back(cell);
  }
  if (!beyond.empty()) return beyond;
  goal_ = std::move(goal);
  control_ = control;
  return {};
}

Mat3d PlasticCells::goal(std::size_t slot, std::size_t q) const {
  Mat3d symmetric{};
  for (std::size_t row = 0, i = 0; row < 3; ++row)
    for (std::size_t column = 0; column <= row; ++column, ++i)
      symmetric(row, column) = symmetric(column, row) = goal_[goal_index(slot, q, i)];
  return symmetric;
}

double PlasticCells::square_of_goal() const {
  if (goal_.empty()) return 0;
  double sum = 0;
  for (const LocalIndex slot : slot_of_cell_)
    for (std::size_t q = 0; q < block_.element.points(); ++q) {
      const Mat3d log_goal = goal(static_cast<std::size_t>(slot), q);
      sum += volume(static_cast<std::size_t>(slot), q) * contract(log_goal, log_goal);
    }
  return sum;
}

double PlasticCells::square_distance_to_goal() const {
  if (goal_.empty()) return 0;
  double sum = 0;
  for (const LocalIndex of_cell : slot_of_cell_)
    for (std::size_t q = 0; q < block_.element.points(); ++q) {
      const auto slot = static_cast<std::size_t>(of_cell);
      const Mat3d left = kernels::log_stretch(deformation(slot, q)) - goal(slot, q);
      sum += volume(slot, q) * contract(left, left);
    }
  return sum;
}

std::size_t PlasticCells::index(std::size_t slot, std::size_t q, std::size_t number,
                                std::size_t numbers) const {
  const auto lanes = static_cast<std::size_t>(block_.lanes);
  const std::size_t point = slot / lanes * block_.element.points() + q;
  return (point * numbers + number) * lanes + slot % lanes;
}

double PlasticCells::volume(std::size_t slot, std::size_t q) const {
  return block_.volumes[index(slot, q, 0, 1)];
}

std::size_t PlasticCells::index(std::size_t slot, std::size_t q, std::size_t number) const {
  return index(slot, q, number, plastic_numbers);
}

std::size_t PlasticCells::goal_index(std::size_t slot, std::size_t q, std::size_t number) const {
  return index(slot, q, number, goal_numbers);
}

std::size_t PlasticCells::slot_of(LocalIndex cell) const {
  return static_cast<std::size_t>(slot_of_cell_[static_cast<std::size_t>(cell)]);
}

LowerTriangle<double> PlasticCells::deformation(std::size_t slot, std::size_t q) const {
  const auto number = [&](std::size_t i) { return state_[index(slot, q, i)]; };
  return {number(0), number(1), number(2), number(3), number(4), number(5)};
}

template <class ValueOf>
double PlasticCells::mean(std::size_t slot, ValueOf&& value_of) const {
  double sum = 0, of_cell = 0;
  for (std::size_t q = 0; q < block_.element.points(); ++q) {
    const double of_point = volume(slot, q);
    sum += of_point * value_of(q);
    of_cell += of_point;
  }
  return sum / of_cell;
}

double PlasticCells::sum(std::size_t number) const {
  double all = 0;
  for (const LocalIndex slot : slot_of_cell_)
    for (std::size_t q = 0; q < block_.element.points(); ++q)
      all += volume(static_cast<std::size_t>(slot), q) *
             state_[index(static_cast<std::size_t>(slot), q, number)];
  return all;
}

double PlasticCells::equivalent_strain(LocalIndex cell) const {
  const auto slot = slot_of(cell);
  return Plasticity::equivalent_strain(mean(slot, [&](std::size_t q) { return state_[index(slot, q, 6)]; }));
}

double PlasticCells::volume_ratio(LocalIndex cell) const {
  const auto slot = slot_of(cell);
  return mean(slot, [&](std::size_t q) { return determinant(deformation(slot, q)); });
}

std::size_t PlasticCells::numbers_per_cell() const {
  return block_.element.points() * plastic_numbers + numbers_besides;
}

void PlasticCells::settle(std::size_t slot, float largest, float spin) {
  settled_largest_[slot] = largest;
  settled_spin_[slot] = spin;
  drift_[slot] = 0;
}

double PlasticCells::largest_alpha(LocalIndex cell) const {
  const auto slot = slot_of(cell);
  double largest = 0;
  for (std::size_t q = 0; q < block_.element.points(); ++q)
    largest = std::max(largest, state_[index(slot, q, 6)]);
  return largest;
}

double PlasticCells::way(LocalIndex cell) const {
  return largest_alpha(cell) - way_from_[static_cast<std::size_t>(cell)];
}

bool PlasticCells::is_beyond_bounds() const {
  for (LocalIndex cell = 0; cell < block_.cells; ++cell)
    if (largest_alpha(cell) > way_until_[static_cast<std::size_t>(cell)]) return true;
  return false;
}

void PlasticCells::bound_way(LocalIndex cell, double most) {
  way_until_[static_cast<std::size_t>(cell)] = way_from_[static_cast<std::size_t>(cell)] + most;
}

void PlasticCells::set_way(LocalIndex cell, double way) {
  way_from_[static_cast<std::size_t>(cell)] = largest_alpha(cell) - way;
}

void PlasticCells::shape_gradients(LocalIndex cell, std::span<Vec3d> gradients) const {
  const NodeVectors all = rest_point(block_, slot_of(cell), 0).gradients;
  std::copy_n(all.begin(), block_.element.nodes(), gradients.begin());
}

void PlasticCells::exchange_shapes() {
  std::swap_ranges(rest_shapes_.begin(), rest_shapes_.end(), arrays_.shapes);
}

void PlasticCells::get(LocalIndex cell, std::span<double> numbers) const {
  EVERT_ASSERT(numbers.size() == numbers_per_cell(), std::to_string(numbers.size()));
  const auto slot = slot_of(cell);
  const std::size_t of_points = numbers.size() - numbers_besides;
  for (std::size_t i = 0; i < of_points; ++i)
    numbers[i] = state_[index(slot, i / plastic_numbers, i % plastic_numbers)];
  numbers[of_points] = settled_largest_[slot];
  numbers[of_points + 1] = settled_spin_[slot];
  numbers[of_points + 2] = drift_[slot];
}

void PlasticCells::set(LocalIndex cell, std::span<const double> numbers) {
  EVERT_ASSERT(numbers.size() == numbers_per_cell(), std::to_string(numbers.size()));
  const auto slot = slot_of(cell);
  const std::size_t of_points = numbers.size() - numbers_besides;
  for (std::size_t i = 0; i < of_points; ++i)
    state_[index(slot, i / plastic_numbers, i % plastic_numbers)] = numbers[i];
  const auto batch = static_cast<LocalIndex>(slot / static_cast<std::size_t>(block_.lanes));
  deform_shapes_(arrays_, {batch, batch + 1});
  settled_largest_[slot] = static_cast<float>(numbers[of_points]);
  settled_spin_[slot] = static_cast<float>(numbers[of_points + 1]);
  drift_[slot] = static_cast<float>(numbers[of_points + 2]);
}

Mat3d PlasticCells::rotation(std::size_t slot, std::size_t q) const {
  return polar_rotation(deflate(matrix(deformation(slot, q))));
}

std::size_t PlasticCells::memory() const {
  return (rest_shapes_.capacity() + state_.capacity() + goal_.capacity()) * sizeof(double) +
         3 * drift_.capacity() * sizeof(float) + 2 * way_from_.capacity() * sizeof(double) +
         slot_of_cell_.capacity() * sizeof(LocalIndex);
}

}  // namespace evert
