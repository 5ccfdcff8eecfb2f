#include "rest_stiffness.hpp"

#include "evert/elements/reference_element.hpp"
#include "evert/math/eigen_symmetric3.hpp"

#include <Eigen/Eigenvalues>

#include "rest_point.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace evert {
namespace {

/// One point: the eigenvalues are those of two 3×3 problems.
template <int nodes>
double one_point_stiffness(const RestPoint<nodes>& point, double mass_share, const Lame& lame) {
  Mat3d squares{};
  for (const Vec3d& g : point.gradients) squares += outer(g, g);
  const Vec3d gamma = eigen_symmetric3(squares).values;
  Mat3d stretching{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      stretching(i, j) =
          (lame.lambda + (i == j ? 2 * lame.mu : 0)) * std::sqrt(std::max(gamma[i] * gamma[j], 0.0));
    }
  }
  const double largest = std::max(2 * lame.mu * gamma[2], eigen_symmetric3(stretching).values[2]);
  return point.volume / mass_share * largest;
}

/// Any number of points: the dense generalised eigenproblem of the cell.
template <int nodes, int points>
double dense_stiffness(const std::array<RestPoint<nodes>, points>& at,
                       const std::array<double, nodes>& masses, const Lame& lame) {
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
  return Solver(stiffness, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

}  // namespace

AlignedVector<double> rest_stiffness(const ElementBlock& block, double density, const Lame& lame) {
  return with_reference_element(block.type,
                                [&]<int nodes, int points>(const ReferenceElement<nodes, points>& element) {
                                  AlignedVector<double> stiffness(block.cell_of_lane.size(), 0.0);
                                  for (std::size_t slot = 0; slot < stiffness.size(); ++slot) {
                                    if (block.cell_of_lane[slot] < 0) continue;
                                    std::array<RestPoint<nodes>, points> at;
                                    std::array<double, nodes> masses{};
                                    for (std::size_t q = 0; q < points; ++q) {
                                      at[q] = rest_point<nodes, points>(block, slot, q);
                                      for (std::size_t a = 0; a < nodes; ++a)
                                        masses[a] += density * at[q].volume * element.values[q][a];
                                    }
                                    if constexpr (points == 1) {
                                      stiffness[slot] = one_point_stiffness(at[0], masses[0], lame);
                                    } else {
                                      stiffness[slot] = dense_stiffness<nodes, points>(at, masses, lame);
                                    }
                                  }
                                  return stiffness;
                                });
}

}  // namespace evert
