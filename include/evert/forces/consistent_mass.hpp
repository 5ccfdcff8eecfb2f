#pragma once
#include "evert/mesh/distributed_mesh.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace evert {

/// The matrix ∫ρ N_a N_b dX of this rank's cells, exact for curved cells too; it acts alike on x, y and z.
/// Compressed rows over owned nodes and ghosts: the sum over the ranks is left to who exchanges ghosts.
class ConsistentMass {
 public:
  /// Collective. `densities` ρ per region [kg/m^3].
  ConsistentMass(const DistributedMesh& mesh, const Halo& halo, std::span<const double> densities);

  /// Not collective. `out` += factor · M v for all local nodes; ghosts of `v` must be up to date, those of
  /// `out` are still to be summed.
  void add(std::span<const double> v, std::span<double> out, double factor) const;

  /// M 1 per owned node, summed over ranks [kg]: ∫ρ N_a dX, what a node has of a weight. Negative at the
  /// corners of tet10.
  [[nodiscard]] std::span<const double> row_sums() const { return row_sums_; }
  /// M_aa per owned node, summed over ranks [kg]. Positive.
  [[nodiscard]] std::span<const double> diagonal() const { return diagonal_; }

  /// take(row, column, M_ab) for every entry that this rank has, by local nodes.
  template <class Take>
  void for_each_entry(Take&& take) const {
    for (std::size_t row = 0; row + 1 < first_.size(); ++row)
      for (auto k = first_[row]; k < first_[row + 1]; ++k)
        take(static_cast<LocalIndex>(row), columns_[k], values_[k]);
  }

  /// Operations of a product, for PETSc's log.
  [[nodiscard]] double flops() const { return 6.0 * static_cast<double>(values_.size()); }
  /// Bytes held.
  [[nodiscard]] std::size_t memory() const;

 private:
  void make_pattern(const DistributedMesh& mesh);
  void add_cells(const DistributedMesh& mesh, std::span<const double> densities);
  [[nodiscard]] double& entry(LocalIndex row, LocalIndex column);

  std::vector<std::size_t> first_;   // of each row in the two below; one more at the end
  std::vector<LocalIndex> columns_;  // rising in each row
  std::vector<double> values_;
  std::vector<double> row_sums_, diagonal_;
};

/// Collective. The smallest c with M_lumped ≤ c M_consistent in every cell of every rank, and so for the
/// whole mesh: 5 for tet4, 12 for wedge6, 27 for hex8 with straight edges. Throws UserError where a cell is
/// so deformed at rest that |∂X/∂ξ| is not positive everywhere that masses are integrated.
[[nodiscard]] double lumped_over_consistent(const DistributedMesh& mesh);

}  // namespace evert
