#include "evert/core/error.hpp"
#include "evert/forces/elastic_forces.hpp"
#include "evert/forces/plastic_cells.hpp"

#include <algorithm>
#include <string>
#include <utility>

/// What ElasticForces has of flow, over all of its blocks.
namespace evert {

void ElasticForces::set_times(double last, double next) {
  for (const auto& block : blocks_)
    if (block != nullptr && block->plastic() != nullptr) block->plastic()->set_times(last, next);
}

bool ElasticForces::may_flow() const {
  return std::ranges::any_of(
      properties_, [](const ElasticProperties& of_region) { return of_region.plasticity.has_value(); });
}

PlasticState ElasticForces::plastic_state() const {
  PlasticState sum;
  for (const auto& block : blocks_) {
    if (block == nullptr || block->plastic() == nullptr) continue;
    const PlasticCells& cells = *block->plastic();
    sum.work += cells.work();
    sum.control_work += cells.control_work();
    sum.goal_square += cells.square_of_goal();
    sum.goal_distance_square += cells.square_distance_to_goal();
  }
  return sum;
}

template <class Work>
void ElasticForces::for_each_flowing(std::size_t entry, Work&& work) const {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (blocks_[b] == nullptr || blocks_[b]->plastic() == nullptr || entry_of(b) != entry) continue;
    const auto cells = cells_in(b);
    for (std::size_t i = 0; i < cells.size(); ++i)
      work(*blocks_[b]->plastic(), static_cast<LocalIndex>(i), static_cast<std::size_t>(cells[i]));
  }
}

void ElasticForces::equivalent_plastic_strain(std::size_t entry, std::span<double> per_cell) const {
  for_each_flowing(entry, [&](const PlasticCells& plastic, LocalIndex i, std::size_t cell) {
    per_cell[cell] = plastic.equivalent_strain(i);
  });
}

void ElasticForces::plastic_volume_ratio(std::size_t entry, std::span<double> per_cell) const {
  for_each_flowing(entry, [&](const PlasticCells& plastic, LocalIndex i, std::size_t cell) {
    per_cell[cell] = plastic.volume_ratio(i);
  });
}

std::size_t ElasticForces::flow_numbers(std::size_t entry) const {
  const auto& cells = mesh_.cells[entry];
  if (!properties(cells.region).plasticity) return 0;
  return PlasticCells::numbers_per_point * static_cast<std::size_t>(quadrature_points(cells.type)) +
         PlasticCells::numbers_besides;
}

std::vector<double> ElasticForces::flow(std::size_t entry) const {
  const std::size_t count = flow_numbers(entry);
  std::vector<double> numbers(count * static_cast<std::size_t>(mesh_.cells[entry].size()));
  for_each_flowing(entry, [&](const PlasticCells& plastic, LocalIndex i, std::size_t cell) {
    plastic.get(i, std::span(numbers).subspan(count * cell, count));
  });
  return numbers;
}

void ElasticForces::set_flow(std::size_t entry, std::span<const double> numbers) {
  const std::size_t count = flow_numbers(entry);
  const auto cells = static_cast<std::size_t>(mesh_.cells[entry].size());
  const std::size_t row = cells > 0 ? numbers.size() / cells : 0;
  EVERT_ASSERT(row >= count || cells == 0, std::to_string(row));
  for_each_flowing(entry, [&](PlasticCells& plastic, LocalIndex i, std::size_t cell) {
    plastic.set(i, numbers.subspan(row * cell, count));
  });
}

std::vector<GlobalIndex> ElasticForces::apply(const Goal& goal, std::size_t block) {
  if (!is_of_region(block, goal.region) || blocks_[block]->plastic() == nullptr) return {};
  const std::size_t entry = entry_of(block);
  const auto cells = cells_in(block);
  const auto of_cell = [&](LocalIndex i, std::size_t node) {
    return goal.position(entry, cells[static_cast<std::size_t>(i)], node);
  };
  std::vector<GlobalIndex> refused;
  for (const LocalIndex i : blocks_[block]->plastic()->set_goal(goal.control, of_cell))
    refused.push_back(
        mesh_.cells[entry].global_ids[static_cast<std::size_t>(cells[static_cast<std::size_t>(i)])]);
  return refused;
}

std::vector<GlobalIndex> ElasticForces::set_goal(std::int32_t region, const PlasticControl& control,
                                                 const GoalPosition& position) {
  goals_.push_back({region, control, position});
  std::vector<GlobalIndex> refused;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto of_block = apply(goals_.back(), b);
    refused.insert(refused.end(), of_block.begin(), of_block.end());
  }
  return refused;
}

bool ElasticForces::flow_is_beyond_bounds() const {
  return std::ranges::any_of(blocks_, [](const auto& block) {
    return block != nullptr && block->plastic() != nullptr &&
           std::as_const(*block).plastic()->is_beyond_bounds();
  });
}

void ElasticForces::way_of_flow(std::size_t entry, std::span<double> per_cell) const {
  for_each_flowing(entry, [&](const PlasticCells& plastic, LocalIndex i, std::size_t cell) {
    per_cell[cell] = plastic.way(i);
  });
}

void ElasticForces::set_way_of_flow(std::size_t entry, std::span<const double> per_cell) {
  for_each_flowing(entry, [&](PlasticCells& plastic, LocalIndex i, std::size_t cell) {
    plastic.set_way(i, per_cell[cell]);
  });
}

void ElasticForces::bound_way_of_flow(std::size_t entry, std::span<const double> per_cell) {
  for_each_flowing(entry, [&](PlasticCells& plastic, LocalIndex i, std::size_t cell) {
    plastic.bound_way(i, per_cell[cell]);
  });
}

void ElasticForces::flown_gradients(std::size_t entry, std::span<Vec3d> gradients) const {
  for_each_flowing(entry, [&](const PlasticCells& plastic, LocalIndex i, std::size_t cell) {
    plastic.shape_gradients(i, gradients.subspan(4 * cell, 4));
  });
}

std::size_t ElasticForces::plastic_memory() const {
  std::size_t bytes = 0;
  for (const auto& block : blocks_)
    if (block != nullptr && block->plastic() != nullptr) bytes += std::as_const(*block).plastic()->memory();
  return bytes;
}

}  // namespace evert
