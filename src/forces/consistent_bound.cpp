#include "consistent_bound.hpp"

#include "evert/elements/reference_element.hpp"
#include "evert/elements/rest_shape.hpp"

#include <Eigen/Eigenvalues>

#include "cell_mass.hpp"
#include <algorithm>
#include <array>
#include <limits>

namespace evert {
namespace {

/// Of one cell, on the stack.
constexpr int most_unknowns = 3 * static_cast<int>(most_nodes);
using CellMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most_unknowns, most_unknowns>;

/// The stiffness that rest_stiffness.hpp speaks of, Σ_q V_q B_qᵀ (2μ I + λ I⊗I) B_q.
CellMatrix stiffness_of(const ElementView& element, std::span<const LocalIndex> cell,
                        std::span<const Vec3d> rest_positions, const Lame& lame) {
  const auto size = static_cast<Eigen::Index>(3 * cell.size());
  CellMatrix stiffness = CellMatrix::Zero(size, size);
  std::array<Vec3d, most_nodes> gradients{};
  for (std::size_t q = 0; q < element.points(); ++q) {
    const Mat3d jacobian = rest_jacobian(element, q, cell, rest_positions);
    const double volume = point_volume(element, q, jacobian);
    const Mat3d to_reference = inverse(jacobian);
    for (std::size_t a = 0; a < cell.size(); ++a)
      gradients[a] = transpose_times(to_reference, element.gradient(q, a));
    for (std::size_t a = 0; a < cell.size(); ++a) {
      for (std::size_t b = 0; b < cell.size(); ++b) {
        const Mat3d block = (2 * lame.mu * dot(gradients[a], gradients[b])) * identity<double>() +
                            lame.lambda * outer(gradients[a], gradients[b]);
        for (std::size_t k = 0; k < 9; ++k)
          stiffness(static_cast<Eigen::Index>(3 * a + k / 3), static_cast<Eigen::Index>(3 * b + k % 3)) +=
              volume * block(k / 3, k % 3);
      }
    }
  }
  return stiffness;
}

CellMatrix mass_of(const CellMass& volumes, double density) {
  const auto size = static_cast<Eigen::Index>(3 * volumes.nodes());
  CellMatrix mass = CellMatrix::Zero(size, size);
  for (std::size_t a = 0; a < volumes.nodes(); ++a)
    for (std::size_t b = 0; b < volumes.nodes(); ++b)
      for (std::size_t k = 0; k < 3; ++k)
        mass(static_cast<Eigen::Index>(3 * a + k), static_cast<Eigen::Index>(3 * b + k)) =
            density * volumes(a, b);
  return mass;
}

double largest_of_block(const ElasticBlock& block, const LocalCells& cells, double density,
                        std::span<const Vec3d> rest_positions) {
  const ElementView element = reference_element(cells.type);
  if (element.points() == 1) return std::numeric_limits<double>::infinity();
  const Lame lame = std::visit([](const auto& model) { return model.lame.regular(); }, block.material());
  CellMass volumes(cells.type);
  double largest = 1;
  for (LocalIndex cell = 0; cell < cells.size(); ++cell) {
    const double taken = block.rest_stiffness_of(cell);
    if (!(taken > 0)) continue;  // E = 0 limits no step
    const auto nodes =
        std::span(cells.nodes).subspan(static_cast<std::size_t>(cell) * element.nodes(), element.nodes());
    volumes.compute(nodes, rest_positions);
    const Eigen::GeneralizedSelfAdjointEigenSolver<CellMatrix> modes(
        stiffness_of(element, nodes, rest_positions, lame), mass_of(volumes, density),
        Eigen::EigenvaluesOnly);
    if (modes.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, modes.eigenvalues()[modes.eigenvalues().size() - 1] / taken);
  }
  return largest;
}

}  // namespace

double consistent_over_block_stiffness(const DistributedMesh& mesh, std::span<const double> densities,
                                       std::span<const std::unique_ptr<ElasticBlock>> blocks) {
  double largest = 1;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (blocks[b] == nullptr) continue;
    const auto& cells = mesh.cells[b];
    largest = std::max(largest,
                       largest_of_block(*blocks[b], cells, densities[static_cast<std::size_t>(cells.region)],
                                        mesh.rest_positions));
  }
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return largest;
}

}  // namespace evert
