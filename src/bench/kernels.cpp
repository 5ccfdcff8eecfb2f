#include "evert/bench/kernels.hpp"

#include "evert/core/collective.hpp"

#include "kernel_subjects.hpp"
#include <algorithm>
#include <array>

namespace evert::bench {
namespace {

enum class Yardstick { none, naive, baij };

/// A workload, and what its rate is to be compared with.
struct Kernel {
  std::string key;
  std::string title;
  std::string unit;
  Workload workload;
  Yardstick yardstick = Yardstick::none;
  KernelCost cost;  // of an item
};

KernelCost with_nodes(KernelCost cells, double nodes_per_item) {
  return {cells.flops, cells.divisions, cells.bytes + nodes_per_item * nodal_bytes};
}

std::string model_of(const Material& material) {
  return std::visit([](const auto& one) { return std::string(one.name); }, material);
}

/// Adds the forces of the other materials of tetrahedra or hexahedra.
template <class Subject>
void add_other_materials(std::vector<Kernel>& kernels, CellType type, Subject& subject, double points,
                         double nodes_per_point) {
  const bool tets = type == CellType::tet4;
  for (const auto& of : subject.others())
    kernels.push_back({(tets ? "tet_" : "hex_") + model_of(of->material) + (tets ? "_mps" : "_mqps"),
                       std::string(name_of(type)) + " " + model_of(of->material),
                       tets ? "Mtet/s" : "Mpoint/s",
                       {points, [&subject, &of] { subject.force(*of); }},
                       Yardstick::naive,
                       with_nodes(force_cost(type, of->material), nodes_per_point)});
}

std::string filtered_key(const std::string& model) { return "tet_filtered_" + model + "_mps"; }

/// Adds the forces of filtered tetrahedra.
void add_filtered(std::vector<Kernel>& kernels, TetSubject& subject) {
  for (const auto& of : subject.filtered())
    kernels.push_back({filtered_key(model_of(of.material)),
                       "filtered " + model_of(of.material),
                       "Mtet/s",
                       {subject.cells(), [&subject, &of] { subject.force(of); }},
                       Yardstick::naive,
                       {}});
}

/// The force of one element.
Kernel force_kernel(const std::string& key, CellType type, ElementSubject& cells) {
  const auto cost = with_nodes(force_cost(type, bench_material()), cells.nodes_per_point());
  const Workload force{cells.points(), [&] { cells.force(); }};
  return {key, std::string(name_of(type)) + " force", "Mpoint/s", force, Yardstick::naive, cost};
}

std::vector<Kernel> kernels_of(TetSubject& tets, HexSubject& hexes, ElementSubject& wedges,
                               ElementSubject& quadratic) {
  const double nodes = tets.nodes_per_cell();
  const auto damping = with_nodes(damping_cost(CellType::tet4, DampingModel::rotated), nodes);
  return {
      {"tet_force_mps",
       "tet4 force",
       "Mtet/s",
       {tets.cells(), [&] { tets.force(); }},
       Yardstick::naive,
       with_nodes(force_cost(CellType::tet4, bench_material()), nodes)},
      {"tet_force_damped_mps",
       "tet4 force, keeps damping",
       "Mtet/s",
       {tets.cells(), [&] { tets.damped_force(); }},
       Yardstick::naive,
       with_nodes(force_cost(CellType::tet4, bench_material(), DampingModel::rotated), nodes)},
      {"tet_plastic_elastic_mps",
       "tet4 force, may flow",
       "Mtet/s",
       {tets.cells(), [&] { tets.elastic_force_of_plastic(); }},
       Yardstick::naive,
       {}},
      {"tet_plastic_flowing_mps",
       "tet4 force, flowing",
       "Mtet/s",
       {tets.cells(), [&] { tets.flowing_force(); }},
       Yardstick::naive,
       {}},
      force_kernel("hex_force_mqps", CellType::hex8, hexes),
      force_kernel("wedge6_force_mqps", CellType::wedge6, wedges),
      force_kernel("tet10_force_mqps", CellType::tet10, quadratic),
      {"general_path_mqps",
       "hex8 force by U and V",
       "Mpoint/s",
       {hexes.points(), [&] { hexes.general_force(); }},
       Yardstick::naive,
       with_nodes(general_path_cost(), hexes.nodes_per_point())},
      {"svd_mps",
       "SVD with U and V",
       "Msvd/s",
       {tets.cells_per_part(), [&] { tets.svd_part(); }},
       Yardstick::none,
       svd_cost()},
      {"damping_mtps",
       "damping product",
       "Mtet/s",
       {tets.cells(), [&] { tets.damping(); }},
       Yardstick::baij,
       damping},
      {"damping_matmult_mtps",
       "damping MatMult, shell",
       "Mtet/s",
       {tets.cells(), [&] { tets.matrix_free_product(); }},
       Yardstick::baij,
       damping},
      {"baij_matmult_mtps",
       "damping MatMult, BAIJ",
       "Mtet/s",
       {tets.cells(), [&] { tets.baij_product(); }},
       Yardstick::baij,
       with_nodes(tets.baij_cost(), nodes)},
      {"naive_tet_force_mps",
       "naive tet4 force",
       "Mtet/s",
       {tets.cells_per_part(), [&] { tets.naive_force_part(); }},
       Yardstick::naive,
       {}},
  };
}

/// The largest of the times that the machine needs at least, over the time taken.
void compare_with_ceilings(KernelRate& kernel, const KernelSizeReport& report) {
  const auto take = [&](double needed, const Rate& available, const char* name) {
    const double share = needed / available.median * kernel.rate.median;
    if (share <= kernel.of_ceiling) return;
    kernel.of_ceiling = share;
    kernel.ceiling = name;
  };
  take(kernel.cost.flops, report.flops, "flops");
  take(kernel.cost.divisions, report.divisions, "divisions");
  take(kernel.cost.bytes, report.bytes, "bytes");
}

double median_of(std::span<const KernelRate> kernels, const std::string& key) {
  return std::ranges::find(kernels, key, &KernelRate::key)->rate.median;
}

std::vector<FilteredCost> filtered_costs(const TetSubject& tets, std::span<const KernelRate> kernels) {
  std::vector<FilteredCost> all;
  for (const auto& of : tets.filtered()) {
    const auto model = model_of(of.material);
    const auto unfiltered = model == model_of(bench_material()) ? "tet_force_mps" : "tet_" + model + "_mps";
    all.push_back({model, median_of(kernels, unfiltered) / median_of(kernels, filtered_key(model))});
  }
  return all;
}

double sum_over_ranks(MPI_Comm comm, double value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, comm);
  return value;
}

}  // namespace

std::span<const KernelSize> kernel_sizes() {
  static const std::array<KernelSize, 3> sizes{
      {{"small", 6, 6}, {"100K", 26, 26}, {"1M", 55, 48}}};  // 1296, 105,456 and 998,250 tetrahedra
  return sizes;
}

KernelSizeReport measure_kernels(MPI_Comm comm, const KernelSize& size, double seconds) {
  TetSubject tets(comm, size.tet_divisions);
  HexSubject hexes(comm, size.hex_divisions);
  // About as many points as the hexahedra have: twelve a cube in wedges, twenty-four in quadratic tetrahedra.
  ElementSubject wedges(comm, CellType::wedge6, size.hex_divisions * 7 / 8);
  ElementSubject quadratic(comm, CellType::tet10, size.hex_divisions * 2 / 3);
  CeilingSubject ceilings(tets.memory());

  auto kernels = kernels_of(tets, hexes, wedges, quadratic);
  add_other_materials(kernels, CellType::tet4, tets, tets.cells(), tets.nodes_per_cell());
  add_filtered(kernels, tets);
  add_other_materials(kernels, CellType::hex8, hexes, hexes.points(), hexes.nodes_per_point());
  std::vector<Workload> workloads;
  for (const auto& kernel : kernels) workloads.push_back(kernel.workload);
  workloads.push_back({sum_over_ranks(comm, CeilingSubject::flops()), [&] { ceilings.multiply_add(); }});
  workloads.push_back(
      {sum_over_ranks(comm, CeilingSubject::divisions()), [&] { ceilings.divide_and_root(); }});
  workloads.push_back({sum_over_ranks(comm, ceilings.triad_bytes()), [&] { ceilings.triad(); }});
  const auto measured = measure(comm, workloads, seconds);

  const auto ceiling_rates = std::span(measured.rates).last(3);
  KernelSizeReport report{.size = size.name,
                          .tets = static_cast<GlobalIndex>(tets.cells()),
                          .hexes = static_cast<GlobalIndex>(hexes.cells()),
                          .inverted = tets.inverted(),
                          .rounds = measured.rounds,
                          .flops = ceiling_rates[0],
                          .divisions = ceiling_rates[1],
                          .bytes = ceiling_rates[2],
                          .kernels = {},
                          .filtered_costs = {}};
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const auto& [key, title, unit, workload, yardstick, cost] = kernels[i];
    report.kernels.push_back(
        {.key = key, .title = title, .unit = unit, .rate = measured.rates[i], .cost = cost, .ceiling = {}});
    compare_with_ceilings(report.kernels.back(), report);
  }
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    auto& kernel = report.kernels[i];
    if (kernels[i].yardstick == Yardstick::naive)
      kernel.of_naive = kernel.rate.median / median_of(report.kernels, "naive_tet_force_mps");
    if (kernels[i].yardstick == Yardstick::baij)
      kernel.of_baij = kernel.rate.median / median_of(report.kernels, "baij_matmult_mtps");
  }
  report.filtered_costs = filtered_costs(tets, report.kernels);
  return report;
}

}  // namespace evert::bench
