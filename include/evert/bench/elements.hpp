#pragma once
#include "evert/bench/kernel_report.hpp"
#include "evert/bench/linear_beam.hpp"

#include <span>
#include <string>
#include <vector>

/// `evert bench elements`: which element for which accuracy (paper A, section 11), on a bending beam.
namespace evert::bench {

/// A way to fill the beam.
struct ElementKind {
  std::string name;
  BoxCells cells;
  bool quadratic;
};
[[nodiscard]] std::span<const ElementKind> element_kinds();

/// How fine the meshes are, by name: cubes across the beam, and those of the reference of tet10.
struct ElementSize {
  std::string name;
  std::vector<int> across;
  int reference;
};
[[nodiscard]] std::span<const ElementSize> element_sizes();

/// One mesh of the beam.
struct ElementResult {
  std::string kind;
  int across = 0;
  GlobalIndex cells = 0, nodes = 0, points = 0;
  double force_seconds = 0;  ///< processor time of all elastic forces, the best of many samples
  double stable_step = 0;    ///< [s] without damping
  double deflection = 0;     ///< [m] of the tip

  [[nodiscard]] double error(double reference) const { return deflection / reference - 1; }
  /// Processor time for a simulated second at the stable step [s/s].
  [[nodiscard]] double cost() const { return force_seconds / stable_step; }
};

/// What Poisson's ratio does to the stiffness of each kind.
struct LockingRow {
  double poissons_ratio = 0;
  double reference = 0;             ///< [m]
  std::vector<double> deflections;  ///< [m] parallel to element_kinds()
};

struct ElementReport {
  Setting setting;
  Beam beam;
  int reference_across = 0, locking_across = 0;
  double reference = 0;  ///< [m] tip deflection of the finest mesh of tet10
  double theory = 0;     ///< [m] Timoshenko's
  std::vector<ElementResult> results;
  std::vector<LockingRow> locking;
};

/// Collective. Measures every kind at every size; `seconds` of processor time for the forces of each mesh.
[[nodiscard]] ElementReport measure_elements(MPI_Comm comm, const ElementSize& size, double seconds);

void print_table(const ElementReport& report, std::ostream& out);
[[nodiscard]] std::string json_text(const ElementReport& report);
/// Error against cost, a curve for each kind, as SVG.
[[nodiscard]] std::string svg_text(const ElementReport& report);

}  // namespace evert::bench
