#include "evert/bench/kernel_cost.hpp"

#include "evert/elements/reference_element.hpp"
#include "evert/forces/kernels/kernel_table.hpp"
#include "evert/math/svd3.hpp"

#include "counted.hpp"
#include "general_path.hpp"
#include <cstdint>
#include <numeric>
#include <vector>

namespace evert::bench {
namespace {

/// Distinct numbers in memory, without the temporaries on the stack of the function whose variable is `frame`
/// and of those that it called.
double numbers_in_memory(const std::unordered_set<const double*>& numbers, const char& frame) {
  constexpr std::uintptr_t deepest = 1U << 20U;
  const auto on_stack = [&](const double* number) {
    return reinterpret_cast<std::uintptr_t>(&frame) - reinterpret_cast<std::uintptr_t>(number) < deepest;
  };
  double count = 0;
  for (const auto* number : numbers) count += on_stack(number) ? 0 : 1;
  return count;
}

template <class Work>
KernelCost cost_of(Work&& work) {
  const char frame = 0;
  Counted::so_far() = {};
  work();
  const auto& log = Counted::so_far();
  return {log.flops, log.divisions,
          8 * numbers_in_memory(log.read, frame) + 16 * numbers_in_memory(log.written, frame)};
}

/// Unit tetrahedra, half of a unit cube and the cube, nodes in the order of VTK.
std::vector<Vec3d> unit_cell(CellType type) {
  if (type == CellType::tet4) return {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
  if (type == CellType::wedge6)
    return {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{1, 0, 1}}, {{0, 1, 1}}};
  if (type == CellType::tet10)
    return {{{0, 0, 0}},     {{1, 0, 0}},   {{0, 1, 0}},   {{0, 0, 1}},     {{0.5, 0, 0}},
            {{0.5, 0.5, 0}}, {{0, 0.5, 0}}, {{0, 0, 0.5}}, {{0.5, 0, 0.5}}, {{0, 0.5, 0.5}}};
  return {{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{0, 1, 0}},
          {{0, 0, 1}}, {{1, 0, 1}}, {{1, 1, 1}}, {{0, 1, 1}}};
}

/// One cell, deformed by nothing in particular: the kernels have no branches.
template <const auto& element>
struct CountedCell {
  std::vector<double> x;
  std::vector<double> f = std::vector<double>(3 * element.nodes + 1);
  std::unique_ptr<ElasticBlock> block;

  CountedCell(const Material& material, DampingModel damping, const kernels::ElasticKernels& kernels) {
    std::vector<LocalIndex> nodes(element.nodes);
    std::iota(nodes.begin(), nodes.end(), 0);
    const auto rest = unit_cell(element.type);
    for (const Vec3d& p : rest) x.insert(x.end(), {1.1 * p[0] + 0.3 * p[1], p[1], 0.9 * p[2]});
    x.push_back(0);  // the double of slack that kernels may read
    const Vec3d fibre{0.6, 0, 0.8};
    block = make_elastic_block({element.type, nodes, 1, 1, {&fibre, 1}}, rest, material, {damping, 1, 1},
                               kernels);
  }

  void update() { block->update(x.data(), f.data(), block->interior()); }

  /// Per quadrature point, with what is done to whole nodes outside Counted: differences to the first node,
  /// the balance on it, and the sums into f.
  [[nodiscard]] KernelCost per_point(KernelCost counted) const {
    constexpr double nodes_of_cell = element.nodes;
    counted.flops += 3 * (2 * (nodes_of_cell - 1) + nodes_of_cell);
    counted.bytes += nodes_of_cell * sizeof(LocalIndex);
    return {counted.flops / element.points, counted.divisions / element.points,
            counted.bytes / element.points};
  }
};

constexpr NeoHookean neo_hookean{.lame = {1, 1}};

template <const auto& element>
KernelCost force_cost_of(CountedCell<element> cell) {
  return cell.per_point(cost_of([&] { cell.update(); }));
}

/// Those whose cost is asked for.
template <const auto& element>
kernels::ElasticKernels counted_kernels(const Material& material, DampingModel damping) {
  return kernels::with_model(material, damping, []<class Model, DampingModel kind>() {
    auto table = kernels::needs_of_kernels<Counted, element, Model, kind>();
    table.update = kernels::update<Counted, element, Model, kind>;
    if constexpr (kind != DampingModel::none)
      table.add_damping = kernels::add_damping<Counted, element, kind>;
    return table;
  });
}

/// What `visit` says of the element of a type.
template <class Visit>
KernelCost with_element(CellType type, Visit&& visit) {
  switch (type) {
    case CellType::tet4:
      return visit.template operator()<tet4>();
    case CellType::hex8:
      return visit.template operator()<hex8>();
    case CellType::wedge6:
      return visit.template operator()<wedge6>();
    case CellType::tet10:
      return visit.template operator()<tet10>();
  }
  return {};
}

}  // namespace

KernelCost force_cost(CellType type, const Material& material, DampingModel damping) {
  return with_element(
      type, [&]<const auto & element>() {
        return force_cost_of(
            CountedCell<element>(material, damping, counted_kernels<element>(material, damping)));
      });
}

KernelCost general_path_cost() {
  return force_cost_of(
      CountedCell<hex8_by_gradients>(neo_hookean, DampingModel::none, general_hex_kernels<Counted>()));
}

KernelCost damping_cost(CellType type, DampingModel damping) {
  return with_element(
      type, [&]<const auto & element>() {
        CountedCell<element> cell(neo_hookean, damping, counted_kernels<element>(neo_hookean, damping));
        cell.update();
        return cell.per_point(cost_of(
            [&] { cell.block->add_damping(cell.x.data(), cell.f.data(), 1, cell.block->interior()); }));
      });
}

KernelCost svd_cost() {
  const Mat3<Counted> f{{{{1.1, 0.2, 0.1}, {-0.3, 0.9, 0.2}, {0.1, 0.4, 1.2}}}};
  auto cost = cost_of([&] { static_cast<void>(svd3(f)); });
  cost.bytes = sizeof(Mat3d);
  return cost;
}

}  // namespace evert::bench
