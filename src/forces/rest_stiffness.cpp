#include "rest_stiffness.hpp"

#include "evert/elements/reference_element.hpp"
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
template <int nodes>
CellStiffness one_point_stiffness(const RestPoint<nodes>& point, std::span<const double, nodes> masses,
                                  const Lame& lame) {
  Mat3d squares{};
  for (std::size_t a = 0; a < nodes; ++a)
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

/// Any number of points: the dense generalised eigenproblem of the cell.
template <int nodes, int points>
CellStiffness dense_stiffness(const std::array<RestPoint<nodes>, points>& at,
                              std::span<const double, nodes> masses, const Lame& lame) {
  Eigen::Matrix<double, 3 * nodes, 3 * nodes> stiffness;
  stiffness.setZero();
  for (const auto& point : at) {
    for (int a = 0; a < nodes; ++a) {
      for (int b = 0; b < nodes; ++b) {
        const Vec3d& ga = point.gradients[static_cast<std::size_t>(a)];
        const Vec3d& gb = point.gradients[static_cast<std::size_t>(b)];
        const double scale = point.volume / std::sqrt(masses[static_cast<std::size_t>(a)] *
                                                      masses[static_cast<std::size_t>(b)]);
        const Mat3d block = (2 * lame.mu * dot(ga, gb)) * identity<double>() + lame.lambda * outer(ga, gb);
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) {
            stiffness(3 * a + i, 3 * b + j) +=
                scale * block(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
          }
        }
      }
    }
  }
  using Solver = Eigen::SelfAdjointEigenSolver<decltype(stiffness)>;
  const double largest = Solver(stiffness, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
  return {largest, largest};
}

/// All points of the cell in lane number `slot`.
template <int nodes, int points>
std::array<RestPoint<nodes>, points> rest_points(const ReferenceElement<nodes, points>& element,
                                                 const ElementBlock& block, std::size_t slot) {
  std::array<RestPoint<nodes>, points> at;
  for (std::size_t q = 0; q < points; ++q) at[q] = rest_point(element, block, slot, q);
  return at;
}

/// So that a bound stays one.
float rounded_up(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest < x ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

}  // namespace

RestStiffness rest_stiffness(const ElementBlock& block, std::span<const double> mass_shares,
                             const Lame& lame) {
  const auto slots = block.cell_of_lane.size();
  RestStiffness stiffness{AlignedVector<float>(slots, 0.0F), AlignedVector<float>(slots, 0.0F)};
  with_reference_element(block.type,
                         [&]<int nodes, int points>(const ReferenceElement<nodes, points>& element) {
                           for (std::size_t slot = 0; slot < slots; ++slot) {
                             if (block.cell_of_lane[slot] < 0) continue;
                             const auto cell = static_cast<std::size_t>(block.cell_of_lane[slot]);
                             const auto masses = mass_shares.subspan(nodes * cell).template first<nodes>();
                             const auto at = rest_points(element, block, slot);
                             CellStiffness of_cell{};
                             if constexpr (points == 1) {
                               of_cell = one_point_stiffness<nodes>(at[0], masses, lame);
                             } else {
                               of_cell = dense_stiffness<nodes, points>(at, masses, lame);
                             }
                             stiffness.largest[slot] = rounded_up(of_cell.largest);
                             stiffness.spin[slot] = rounded_up(of_cell.spin);
                           }
                         });
  return stiffness;
}

std::vector<double> own_mass_shares(const ElementBlock& block, double density) {
  std::vector<double> shares(static_cast<std::size_t>(block.cells) *
                             static_cast<std::size_t>(node_count(block.type)));
  with_reference_element(block.type,
                         [&]<int nodes, int points>(const ReferenceElement<nodes, points>& element) {
                           for (std::size_t slot = 0; slot < block.cell_of_lane.size(); ++slot) {
                             if (block.cell_of_lane[slot] < 0) continue;
                             const auto cell = static_cast<std::size_t>(block.cell_of_lane[slot]);
                             const auto at = rest_points(element, block, slot);
                             std::array<double, points> volumes;
                             for (std::size_t q = 0; q < points; ++q) volumes[q] = at[q].volume;
                             const auto of_cell = lumped_volumes(element, volumes);
                             for (std::size_t a = 0; a < nodes; ++a)
                               shares[nodes * cell + a] = density * of_cell[a];
                           }
                         });
  return shares;
}

}  // namespace evert
