#include "evert/forces/consistent_mass.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/elements/reference_element.hpp"
#include "evert/elements/rest_shape.hpp"

#include <Eigen/Eigenvalues>

#include "cell_mass.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace evert {
namespace {

std::span<const LocalIndex> nodes_of(const LocalCells& cells, LocalIndex cell) {
  const auto per_cell = static_cast<std::size_t>(node_count(cells.type));
  return std::span(cells.nodes).subspan(static_cast<std::size_t>(cell) * per_cell, per_cell);
}

/// visit(nodes) for every cell of this rank.
template <class Visit>
void for_each_cell_nodes(const DistributedMesh& mesh, Visit&& visit) {
  for (const auto& cells : mesh.cells)
    for (LocalIndex cell = 0; cell < cells.size(); ++cell) visit(nodes_of(cells, cell));
}

/// Collective. `local`, one number a local node, summed over ranks at the owned ones.
std::vector<double> summed(const DistributedMesh& mesh, const Halo& halo, std::span<const double> local) {
  NodeField field(mesh);
  for (std::size_t i = 0; i < field.local().size(); ++i) field.local()[i] = local[i / 3];
  field.touched();
  halo.begin_add(field);
  halo.end_add(field);
  std::vector<double> owned(static_cast<std::size_t>(mesh.owned_nodes));
  for (std::size_t i = 0; i < owned.size(); ++i) owned[i] = field.owned()[3 * i];
  return owned;
}

/// The largest eigenvalue of the lumped volumes of a cell against those of `consistent`, which must have been
/// computed for it.
double largest_ratio(const ElementView& element, const CellMass& consistent, std::span<const LocalIndex> cell,
                     std::span<const Vec3d> rest_positions) {
  constexpr int most = static_cast<int>(most_nodes);
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most, most>;
  std::array<double, most_points> volumes{};
  for (std::size_t q = 0; q < element.points(); ++q)
    volumes[q] = point_volume(element, q, rest_jacobian(element, q, cell, rest_positions));
  const auto lumped = lumped_volumes(element, volumes);
  const auto n = static_cast<int>(element.nodes());
  Matrix scaled(n, n);  // its smallest eigenvalue is one over what is asked for
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      scaled(a, b) = consistent(i, j) / std::sqrt(lumped[i] * lumped[j]);
    }
  const double smallest =
      Eigen::SelfAdjointEigenSolver<Matrix>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[0];
  return 1 / std::max(smallest, std::numeric_limits<double>::epsilon());  // the diagonal is about 1
}

}  // namespace

ConsistentMass::ConsistentMass(const DistributedMesh& mesh, const Halo& halo,
                               std::span<const double> densities) {
  make_pattern(mesh);
  add_cells(mesh, densities);
  std::vector<double> sums(static_cast<std::size_t>(mesh.local_nodes())), diagonal = sums;
  for_each_entry([&](LocalIndex row, LocalIndex column, double value) {
    sums[static_cast<std::size_t>(row)] += value;
    if (row == column) diagonal[static_cast<std::size_t>(row)] = value;
  });
  row_sums_ = summed(mesh, halo, sums);
  diagonal_ = summed(mesh, halo, diagonal);
}

/// A node is coupled with the nodes of its cells.
void ConsistentMass::make_pattern(const DistributedMesh& mesh) {
  const auto rows = static_cast<std::size_t>(mesh.local_nodes());
  std::vector<std::size_t> end(rows + 1);  // of the cells around each node, once they are filled in
  for_each_cell_nodes(mesh, [&](std::span<const LocalIndex> cell) {
    for (const auto node : cell) ++end[static_cast<std::size_t>(node) + 1];
  });
  for (std::size_t row = 0; row < rows; ++row) end[row + 1] += end[row];
  std::vector<std::span<const LocalIndex>> around(end.back());
  for_each_cell_nodes(mesh, [&](std::span<const LocalIndex> cell) {
    for (const auto node : cell) around[end[static_cast<std::size_t>(node)]++] = cell;
  });
  first_.assign(1, 0);
  std::vector<LocalIndex> row_columns;
  for (std::size_t row = 0, k = 0; row < rows; ++row) {
    row_columns.clear();
    for (; k < end[row]; ++k) row_columns.insert(row_columns.end(), around[k].begin(), around[k].end());
    std::ranges::sort(row_columns);
    const auto repeated = std::ranges::unique(row_columns);
    columns_.insert(columns_.end(), row_columns.begin(), repeated.begin());
    first_.push_back(columns_.size());
  }
  values_.assign(columns_.size(), 0.0);
}

void ConsistentMass::add_cells(const DistributedMesh& mesh, std::span<const double> densities) {
  for (const auto& cells : mesh.cells) {
    CellMass volumes(cells.type);
    const double density = densities[static_cast<std::size_t>(cells.region)];
    for (LocalIndex cell = 0; cell < cells.size(); ++cell) {
      const auto nodes = nodes_of(cells, cell);
      const bool has_volume = volumes.compute(nodes, mesh.rest_positions);
      EVERT_ASSERT(has_volume, "cell " + std::to_string(cell));  // lumped_over_consistent has looked
      for (std::size_t a = 0; a < nodes.size(); ++a)
        for (std::size_t b = 0; b < nodes.size(); ++b) entry(nodes[a], nodes[b]) += density * volumes(a, b);
    }
  }
}

double& ConsistentMass::entry(LocalIndex row, LocalIndex column) {
  const auto begin = columns_.begin() + static_cast<std::ptrdiff_t>(first_[static_cast<std::size_t>(row)]);
  const auto end = columns_.begin() + static_cast<std::ptrdiff_t>(first_[static_cast<std::size_t>(row) + 1]);
  return values_[static_cast<std::size_t>(std::lower_bound(begin, end, column) - columns_.begin())];
}

void ConsistentMass::add(std::span<const double> v, std::span<double> out, double factor) const {
  for (std::size_t row = 0; row + 1 < first_.size(); ++row) {
    double x = 0, y = 0, z = 0;
    for (auto k = first_[row]; k < first_[row + 1]; ++k) {
      const double* at = &v[3 * static_cast<std::size_t>(columns_[k])];
      x += values_[k] * at[0];
      y += values_[k] * at[1];
      z += values_[k] * at[2];
    }
    double* sum = &out[3 * row];
    sum[0] += factor * x;
    sum[1] += factor * y;
    sum[2] += factor * z;
  }
}

std::size_t ConsistentMass::memory() const {
  return first_.capacity() * sizeof(std::size_t) + columns_.capacity() * sizeof(LocalIndex) +
         (values_.capacity() + row_sums_.capacity() + diagonal_.capacity()) * sizeof(double);
}

double lumped_over_consistent(const DistributedMesh& mesh) {
  double largest = 1;
  on_every_rank(mesh.comm, [&] {
    for (const auto& cells : mesh.cells) {
      const ElementView element = reference_element(cells.type);
      CellMass volumes(cells.type);
      bool uniform_seen = false;
      for (LocalIndex cell = 0; cell < cells.size(); ++cell) {
        const auto nodes = nodes_of(cells, cell);
        if (!volumes.compute(nodes, mesh.rest_positions))
          throw UserError(std::string(name_of(cells.type)) + " cell " +
                          std::to_string(cells.global_ids[static_cast<std::size_t>(cell)]) +
                          " is folded at rest between its quadrature points, where consistent masses "
                          "('integrator.mass: consistent') need a positive volume: must be mended, or "
                          "'lumped'");
        if (volumes.uniform() && uniform_seen) continue;  // the same ratio as of the one before
        uniform_seen = uniform_seen || volumes.uniform();
        largest = std::max(largest, largest_ratio(element, volumes, nodes, mesh.rest_positions));
      }
    }
  });
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return largest;
}

}  // namespace evert
