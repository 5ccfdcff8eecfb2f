#include "evert/bench/elements.hpp"

#include "evert/bench/sampling.hpp"
#include "evert/core/collective.hpp"
#include "evert/forces/elastic_forces.hpp"
#include "evert/math/nodal.hpp"

#include <array>
#include <memory>

namespace evert::bench {
namespace {

constexpr std::array locking_ratios{0.45, 0.49, 0.499};  // besides that of the beam

/// The elastic forces of one mesh of the beam, slightly bent, to be timed.
class ForceSubject {
 public:
  ForceSubject(MPI_Comm comm, const Mesh& whole, const Beam& beam)
      : mesh_(distribute(comm, whole)),
        elastic_(mesh_, std::array{ElasticProperties{beam.density, NeoHookean{.lame = beam.lame()}, {}}}),
        x_(mesh_),
        f_(mesh_) {
    for (LocalIndex node = 0; node < mesh_.local_nodes(); ++node) {
      auto at = mesh_.rest_positions[static_cast<std::size_t>(node)];
      at[2] -= 0.01 * at[0] * at[0];
      set_node_value(x_.local(), node, at);
    }
    x_.touched();
  }

  void update() { elastic_.update(x_, f_); }
  [[nodiscard]] double stable_step() const {
    double step = elastic_.stable_step(x_).undamped;
    MPI_Allreduce(MPI_IN_PLACE, &step, 1, MPI_DOUBLE, MPI_MIN, mesh_.comm);
    return step;
  }
  [[nodiscard]] const DistributedMesh& mesh() const { return mesh_; }

 private:
  DistributedMesh mesh_;
  ElasticForces elastic_;
  NodeField x_, f_;
};

Mesh mesh_on_root(MPI_Comm comm, const Beam& beam, const ElementKind& kind, int across) {
  Mesh mesh;
  on_root(comm, [&] { mesh = beam_mesh(beam, kind.cells, across, kind.quadratic); });
  return mesh;
}

/// The best element there is: tet10.
double reference_deflection(MPI_Comm comm, const Beam& beam, int across) {
  const auto mesh = mesh_on_root(comm, beam, {"", BoxCells::tet6, true}, across);
  return solve_beam(comm, mesh, beam, false).tip_deflection;
}

GlobalIndex points_in(const DistributedMesh& mesh) {
  GlobalIndex points = 0;
  for (const auto& cells : mesh.cells) points += GlobalIndex{cells.size()} * quadrature_points(cells.type);
  MPI_Allreduce(MPI_IN_PLACE, &points, 1, MPI_INT64_T, MPI_SUM, mesh.comm);
  return points;
}

}  // namespace

std::span<const ElementKind> element_kinds() {
  static const std::vector<ElementKind> kinds{
      {"hex8", BoxCells::hex8, false}, {"tet5", BoxCells::tet5, false},     {"tet6", BoxCells::tet6, false},
      {"bcc", BoxCells::bcc, false},   {"wedge6", BoxCells::wedge6, false}, {"tet10", BoxCells::tet6, true},
  };
  return kinds;
}

std::span<const ElementSize> element_sizes() {
  static const std::vector<ElementSize> sizes{{"small", {2}, 4}, {"full", {2, 4, 6}, 10}};
  return sizes;
}

ElementReport measure_elements(MPI_Comm comm, const ElementSize& size, double seconds) {
  ElementReport report{.setting = current_setting(comm), .beam = {}, .results = {}, .locking = {}};
  const Beam& beam = report.beam;
  report.reference_across = size.reference;
  report.reference = reference_deflection(comm, beam, size.reference);
  report.theory = timoshenko(beam).tip_deflection;

  std::vector<std::unique_ptr<ForceSubject>> subjects;
  std::vector<Workload> workloads;
  for (const int across : size.across) {
    for (const auto& kind : element_kinds()) {
      const auto mesh = mesh_on_root(comm, beam, kind, across);
      auto& subject = *subjects.emplace_back(std::make_unique<ForceSubject>(comm, mesh, beam));
      workloads.push_back({1, [&subject] { subject.update(); }});
      report.results.push_back({kind.name, across, subject.mesh().total_cells, subject.mesh().total_nodes,
                                points_in(subject.mesh()), 0, subject.stable_step(),
                                solve_beam(comm, mesh, beam, false).tip_deflection});
    }
  }
  const auto measured = measure(comm, workloads, seconds);
  for (std::size_t i = 0; i < report.results.size(); ++i)
    report.results[i].force_seconds = 1 / measured.rates[i].best;

  report.locking_across = size.across[size.across.size() / 2];
  LockingRow softest{beam.poissons_ratio, report.reference, {}};  // measured above
  for (const auto& result : report.results)
    if (result.across == report.locking_across) softest.deflections.push_back(result.deflection);
  report.locking.push_back(softest);
  for (const double nu : locking_ratios) {
    Beam stiff = beam;
    stiff.poissons_ratio = nu;
    LockingRow row{nu, reference_deflection(comm, stiff, size.reference), {}};
    for (const auto& kind : element_kinds()) {
      const auto mesh = mesh_on_root(comm, stiff, kind, report.locking_across);
      row.deflections.push_back(solve_beam(comm, mesh, stiff, false).tip_deflection);
    }
    report.locking.push_back(row);
  }
  return report;
}

}  // namespace evert::bench
