#include "evert/bench/naive_forces.hpp"

#include "evert/math/nodal.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace evert::bench {
namespace {

/// D_s or D_m: edges from the first node, as columns.
template <class PositionOf>
Mat3d edges(const std::array<LocalIndex, 4>& nodes, PositionOf&& position_of) {
  const Vec3d first = position_of(nodes[0]);
  return {position_of(nodes[1]) - first, position_of(nodes[2]) - first, position_of(nodes[3]) - first};
}

/// P = U P̂(F̂) Vᵀ.  paper A, section 6
Mat3d stress(const NeoHookean& material, const Mat3d& f) {
  using Matrix = Eigen::Matrix3d;
  const Eigen::Map<const Matrix> map(f.column[0].components.data());
  const Eigen::JacobiSVD<Matrix> svd(map, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix u = svd.matrixU();
  Matrix v = svd.matrixV();
  Vec3d sigma{svd.singularValues()[0], svd.singularValues()[1], svd.singularValues()[2]};
  // Rotations: a reflection is taken out along the smallest stretch, whose sign then tells of inversion.
  if (u.determinant() < 0) {
    u.col(2) *= -1;
    sigma[2] = -sigma[2];
  }
  if (v.determinant() < 0) {
    v.col(2) *= -1;
    sigma[2] = -sigma[2];
  }
  const Vec3d principal = material.principal_stress(sigma);
  const Matrix p = u * Eigen::Vector3d(principal[0], principal[1], principal[2]).asDiagonal() * v.transpose();
  Mat3d result;
  Eigen::Map<Matrix>(result.column[0].components.data()) = p;
  return result;
}

}  // namespace

NaiveForces::NaiveForces(std::span<const LocalIndex> nodes, std::span<const Vec3d> rest_positions,
                         const NeoHookean& material)
    : material_(material) {
  for (std::size_t i = 0; i < nodes.size(); i += 4) {
    const std::array cell{nodes[i], nodes[i + 1], nodes[i + 2], nodes[i + 3]};
    const auto rest =
        edges(cell, [&](LocalIndex node) { return rest_positions[static_cast<std::size_t>(node)]; });
    cells_.push_back({cell, inverse(rest), determinant(rest) / 6});
  }
}

Mat3d NaiveForces::deformation_gradient(std::span<const double> x, std::size_t cell) const {
  const auto now = edges(cells_[cell].nodes, [&](LocalIndex node) { return node_value(x, node); });
  return now * cells_[cell].inverse_rest_edges;
}

void NaiveForces::add(std::span<const double> x, std::span<double> f, std::size_t begin,
                      std::size_t end) const {
  for (std::size_t i = begin; i < end; ++i) {
    const auto& cell = cells_[i];
    const Mat3d p = stress(material_, deformation_gradient(x, i));
    // [f_1 f_2 f_3] = −V P D_m⁻ᵀ.  paper A, eq. (2)
    const Mat3d forces = -cell.volume * times_transpose(p, cell.inverse_rest_edges);
    for (std::size_t a = 1; a < 4; ++a) {
      const Vec3d& of_node = forces.column[a - 1];
      set_node_value(f, cell.nodes[a], node_value(f, cell.nodes[a]) + of_node);
      set_node_value(f, cell.nodes[0], node_value(f, cell.nodes[0]) - of_node);
    }
  }
}

}  // namespace evert::bench
