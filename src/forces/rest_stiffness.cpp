#include "rest_stiffness.hpp"

#include "evert/forces/plastic_cells.hpp"
#include "evert/math/eigen_symmetric3.hpp"

#include <Eigen/Eigenvalues>

#include "rest_point.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace evert {
namespace {

struct CellStiffness {
  double largest, spin;
};

/// One point: the eigenvalues are those of two 3×3 problems.
CellStiffness one_point_stiffness(const RestPoint& point, std::span<const double> masses, const Lame& lame) {
  Mat3d squares{};
  for (std::size_t a = 0; a < masses.size(); ++a)
    squares += (1 / masses[a]) * outer(point.gradients[a], point.gradients[a]);
  const Vec3d gamma = eigen_symmetric3(squares).values;
  Mat3d stretching{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      stretching(i, j) =
          (lame.lambda + (i == j ? 2 * lame.mu : 0)) * std::sqrt(std::max(gamma[i] * gamma[j], 0.0));
    }
  }
  const double largest = std::max(2 * lame.mu * gamma[2], eigen_symmetric3(stretching).values[2]);
  return {point.volume * largest, point.volume * 2 * lame.mu * std::max(gamma[1], 0.0)};
}

/// Of one cell, on the stack.
constexpr int most_unknowns = 3 * static_cast<int>(most_nodes);
using CellMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most_unknowns, most_unknowns>;

/// Adds the stiffness of one point, scaled by the masses.
void add_stiffness(const RestPoint& point, std::span<const double> masses, const Lame& lame,
                   CellMatrix& stiffness) {
  for (std::size_t a = 0; a < masses.size(); ++a) {
    for (std::size_t b = 0; b < masses.size(); ++b) {
      const Vec3d& ga = point.gradients[a];
      const Vec3d& gb = point.gradients[b];
      const double scale = point.volume / std::sqrt(masses[a] * masses[b]);
      const Mat3d block = (2 * lame.mu * dot(ga, gb)) * identity<double>() + lame.lambda * outer(ga, gb);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
          stiffness(static_cast<int>(3 * a + i), static_cast<int>(3 * b + j)) += scale * block(i, j);
      }
    }
  }
}

/// As points of one cell have it in common, which F_p as it is kept turns each in its own way.
RestPoint common_point(const ElementBlock& block, const PlasticCells* flown, std::size_t slot,
                       std::size_t q) {
  RestPoint point = rest_point(block, slot, q);
  if (flown == nullptr) return point;
  const Mat3d rotation = flown->rotation(slot, q);
  for (Vec3d& gradient : point.gradients) gradient = transpose_times(rotation, gradient);
  return point;
}

/// Any number of points: the dense generalised eigenproblem of the cell.
CellStiffness dense_stiffness(const ElementBlock& block, const PlasticCells* flown, std::size_t slot,
                              std::span<const double> masses, const Lame& lame) {
  const auto unknowns = static_cast<int>(3 * masses.size());
  CellMatrix stiffness = CellMatrix::Zero(unknowns, unknowns);
  for (std::size_t q = 0; q < block.element.points(); ++q)
    add_stiffness(common_point(block, flown, slot, q), masses, lame, stiffness);
  using Solver = Eigen::SelfAdjointEigenSolver<CellMatrix>;
  const double largest = Solver(stiffness, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
  return {largest, largest};
}

/// So that a bound stays one.
float rounded_up(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest < x ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

}  // namespace

RestStiffness rest_stiffness(const ElementBlock& block, std::span<const double> mass_shares, const Lame& lame,
                             const PlasticCells* flown) {
  const auto slots = block.cell_of_lane.size();
  RestStiffness stiffness{AlignedVector<float>(slots, 0.0F), AlignedVector<float>(slots, 0.0F)};
  for (std::size_t slot = 0; slot < slots; ++slot)
    if (block.cell_of_lane[slot] >= 0)
      update_rest_stiffness(block, mass_shares, lame, flown, slot, stiffness);
  return stiffness;
}

void update_rest_stiffness(const ElementBlock& block, std::span<const double> mass_shares, const Lame& lame,
                           const PlasticCells* flown, std::size_t slot, RestStiffness& stiffness) {
  const std::size_t nodes = block.element.nodes();
  const auto masses = mass_shares.subspan(nodes * static_cast<std::size_t>(block.cell_of_lane[slot]), nodes);
  const CellStiffness of_cell = block.element.points() == 1
                                    ? one_point_stiffness(rest_point(block, slot, 0), masses, lame)
                                    : dense_stiffness(block, flown, slot, masses, lame);
  stiffness.largest[slot] = rounded_up(of_cell.largest);
  stiffness.spin[slot] = rounded_up(of_cell.spin);
}

std::vector<double> own_mass_shares(const ElementBlock& block, double density) {
  const ElementView& element = block.element;
  std::vector<double> shares(static_cast<std::size_t>(block.cells) * element.nodes());
  for (std::size_t slot = 0; slot < block.cell_of_lane.size(); ++slot) {
    if (block.cell_of_lane[slot] < 0) continue;
    const auto cell = static_cast<std::size_t>(block.cell_of_lane[slot]);
    std::array<double, most_points> volumes{};
    for (std::size_t q = 0; q < element.points(); ++q) volumes[q] = rest_point(block, slot, q).volume;
    const auto of_node = lumped_volumes(element, volumes);
    for (std::size_t a = 0; a < element.nodes(); ++a)
      shares[element.nodes() * cell + a] = density * of_node[a];
  }
  return shares;
}

}  // namespace evert
