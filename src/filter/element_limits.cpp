#include "evert/filter/element_limits.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace evert {
namespace {

constexpr int most_unknowns = 3 * static_cast<int>(most_nodes);
using CellMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most_unknowns, most_unknowns>;
using Masses = std::array<double, most_nodes>;

/// Of the symmetric `matrix` against one mass a node; infinity where it is not finite.
double largest_eigenvalue(std::span<const double> matrix, std::size_t nodes, const Masses& masses) {
  const auto unknowns = static_cast<Eigen::Index>(3 * nodes);
  CellMatrix scaled = CellMatrix::Zero(unknowns, unknowns);
  for (Eigen::Index i = 0; i < unknowns; ++i)
    for (Eigen::Index j = 0; j < unknowns; ++j)
      scaled(i, j) =
          matrix[static_cast<std::size_t>(i * unknowns + j)] /
          std::sqrt(masses[static_cast<std::size_t>(i / 3)] * masses[static_cast<std::size_t>(j / 3)]);
  if (!scaled.allFinite()) return std::numeric_limits<double>::infinity();
  using Solver = Eigen::SelfAdjointEigenSolver<CellMatrix>;
  return Solver(scaled, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

/// What one cell contributes to the masses of its nodes.
Masses own_masses(const LocalCells& cells, std::size_t cell, std::size_t nodes, double density,
                  std::span<const Vec3d> rest_positions) {
  std::array<Vec3d, most_nodes> corners{};
  std::array<LocalIndex, most_nodes> numbers{};
  for (std::size_t a = 0; a < nodes; ++a) {
    numbers[a] = static_cast<LocalIndex>(a);
    corners[a] = rest_positions[static_cast<std::size_t>(cells.nodes[nodes * cell + a])];
  }
  Masses masses{};
  add_lumped_mass({.type = cells.type, .nodes = std::span(numbers).first(nodes), .density = density},
                  std::span(corners).first(nodes), std::span(masses).first(nodes));
  return masses;
}

/// Collective. Masses of all local nodes and the number of cells around them, as the first two components.
NodeField masses_and_degrees(const DistributedMesh& mesh, const ElasticForces& elastic) {
  NodeField field(mesh);
  const auto at = [&](LocalIndex node) { return 3 * static_cast<std::size_t>(node); };
  for (const auto& cells : mesh.cells)
    for (const LocalIndex node : cells.nodes) field.local()[at(node) + 1] += 1;
  elastic.halo().begin_add(field);
  elastic.halo().end_add(field);
  for (LocalIndex node = 0; node < mesh.owned_nodes; ++node)
    field.owned()[at(node)] = elastic.masses()[static_cast<std::size_t>(node)];
  field.touched();
  elastic.halo().begin_update(field);
  elastic.halo().end_update(field);
  return field;
}

}  // namespace

ElementLimits element_limits(const DistributedMesh& mesh, const ElasticForces& elastic, NodeField& x) {
  x.touched();
  elastic.halo().begin_update(x);
  elastic.halo().end_update(x);
  const NodeField nodal = masses_and_degrees(mesh, elastic);
  ElementLimits limits{.own_masses = ElementLimits::PerCell(mesh.cells.size()),
                       .nodal_masses = ElementLimits::PerCell(mesh.cells.size())};
  std::array<double, 3> largest{};
  for (std::size_t e = 0; e < mesh.cells.size(); ++e)
    for (auto* of_cells : {&limits.own_masses[e], &limits.nodal_masses[e]})
      of_cells->resize(static_cast<std::size_t>(mesh.cells[e].size()));
  for (std::size_t b = 0; b < elastic.blocks().size(); ++b) {
    const auto& block = elastic.blocks()[b];
    if (block == nullptr) continue;
    const auto entry = elastic.entry_of(b);
    const auto numbers = elastic.cells_in(b);
    const auto& cells = mesh.cells[entry];
    const double density = elastic.density(cells.region);
    block->stiffness_matrices(
        x.local().data(), TangentForm::full, [&](LocalIndex cell, std::span<const double> matrix) {
          const auto of_cell = block->cell_nodes(cell);
          const auto c = static_cast<std::size_t>(numbers[static_cast<std::size_t>(cell)]);
          const auto own = own_masses(cells, c, of_cell.size(), density, mesh.rest_positions);
          Masses around{};
          for (std::size_t a = 0; a < of_cell.size(); ++a) {
            const auto node = 3 * static_cast<std::size_t>(of_cell[a]);
            around[a] = nodal.local()[node];
            largest[2] = std::max(largest[2], nodal.local()[node + 1]);
          }
          limits.own_masses[entry][c] = largest_eigenvalue(matrix, of_cell.size(), own);
          limits.nodal_masses[entry][c] = largest_eigenvalue(matrix, of_cell.size(), around);
          largest[0] = std::max(largest[0], limits.own_masses[entry][c]);
          largest[1] = std::max(largest[1], limits.nodal_masses[entry][c]);
        });
  }
  MPI_Allreduce(MPI_IN_PLACE, largest.data(), 3, MPI_DOUBLE, MPI_MAX, mesh.comm);
  limits.largest_of_own = largest[0];
  limits.largest_of_nodal = largest[1];
  limits.most_cells_a_node = static_cast<int>(largest[2]);
  return limits;
}

}  // namespace evert
