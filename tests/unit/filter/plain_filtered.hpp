#pragma once
#include "evert/filter/element_modes.hpp"
#include "evert/materials/damping.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <array>

/// One filtered tetrahedron as the formulas stand in docs/design/modal-filter.md, by Eigen's decompositions,
/// in the axes of the world: nothing of it is shared with the kernels but A and the model.
namespace evert::test {

using Matrix3 = Eigen::Matrix3d;
using Forces = std::array<Vec3d, 4>;

inline Matrix3 of(const Mat3d& a) { return Eigen::Map<const Matrix3>(a.column[0].components.data()); }
inline Mat3d of(const Matrix3& a) {
  Mat3d copy;
  Eigen::Map<Matrix3>(copy.column[0].components.data()) = a;
  return copy;
}

/// F = U Σ Vᵀ with rotations U and V.
struct Rotations {
  Matrix3 u, v;
  Eigen::Vector3d sigma;

  explicit Rotations(const Matrix3& f) {
    const Eigen::JacobiSVD<Matrix3> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
    u = svd.matrixU();
    v = svd.matrixV();
    sigma = svd.singularValues();
    for (Matrix3* side : {&u, &v}) {
      if (side->determinant() > 0) continue;
      side->col(2) *= -1;
      sigma[2] *= -1;
    }
  }
};

/// A or Aᵀ of a symmetric tensor of the world.
template <class Apply>
Matrix3 in_axes(const StrainFilter& filter, const Matrix3& tensor, Apply&& apply) {
  const Matrix3 axes = of(filter.axes);
  return axes * of(apply(of(Matrix3(axes.transpose() * tensor * axes)))) * axes.transpose();
}

struct PlainFiltered {
  Forces forces;
  double energy;
  Matrix3 rotation;
  Rotations deformation;
};

inline Matrix3 gradient_of(const TetShape& shape, const Forces& values) {
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t a = 0; a < 4; ++a) sum += of(outer(values[a] - values[0], shape.gradients[a]));
  return sum;
}

/// f_a −= β × r_a, β by a pivoted decomposition of the inertia.
inline void take_torque_off(const Forces& x, Forces& f) {
  Vec3d centroid{}, torque{};
  for (const Vec3d& place : x) centroid += 0.25 * place;
  Matrix3 inertia = Matrix3::Zero();
  for (std::size_t a = 0; a < 4; ++a) {
    const Vec3d r = x[a] - centroid;
    torque += cross(r, f[a]);
    inertia += dot(r, r) * Matrix3::Identity() - of(outer(r, r));
  }
  const Eigen::Vector3d beta = inertia.fullPivLu().solve(Eigen::Vector3d(torque[0], torque[1], torque[2]));
  for (std::size_t a = 0; a < 4; ++a) f[a] -= cross(Vec3d{beta[0], beta[1], beta[2]}, x[a] - centroid);
}

/// S̃ = I + A (S − I), P = R Aᵀ σ(S̃), f_a = −V P g_a without torque.
template <class Model>
PlainFiltered plain_filtered(const Model& model, const TetShape& shape, const StrainFilter& filter,
                             const Forces& x) {
  const Rotations f(gradient_of(shape, x));
  const Matrix3 rotation = f.u * f.v.transpose();
  const Matrix3 strain = f.v * (f.sigma.array() - 1).matrix().asDiagonal() * f.v.transpose();
  const Matrix3 filtered = in_axes(filter, strain, [&](const Mat3d& e) { return filter(e); });
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(Matrix3::Identity() + filtered);
  const Vec3d stretches{axes.eigenvalues()[0], axes.eigenvalues()[1], axes.eigenvalues()[2]};
  const Vec3d principal = model.principal_stress(stretches);
  const Matrix3 stress = axes.eigenvectors() *
                         Eigen::Vector3d(principal[0], principal[1], principal[2]).asDiagonal() *
                         axes.eigenvectors().transpose();
  const Mat3d pull =
      of(Matrix3(rotation * in_axes(filter, stress, [&](const Mat3d& s) { return filter.transposed(s); })));
  PlainFiltered result{{}, shape.volume * model.energy(stretches), rotation, f};
  for (std::size_t a = 0; a < 4; ++a) result.forces[a] = -shape.volume * (pull * shape.gradients[a]);
  take_torque_off(x, result.forces);
  return result;
}

/// A of the damping models.
inline Matrix3 plain_damping_frame(DampingModel model, const PlainFiltered& state) {
  const Matrix3 f =
      state.deformation.u * state.deformation.sigma.asDiagonal() * state.deformation.v.transpose();
  if (model == DampingModel::rotated) return state.rotation;
  if (model == DampingModel::objective) return f;
  const auto& sigma = state.deformation.sigma;
  return f + rotated_share(Vec3d{sigma[0], sigma[1], sigma[2]}) * (state.rotation - f);
}

/// V A_d Aᵀ(2β ė + α tr(ė) I) g_a, ė = A sym(A_dᵀ Ḟ).
inline Forces plain_damping(const Damping& damping, const TetShape& shape, const StrainFilter& filter,
                            const PlainFiltered& state, const Forces& v) {
  const Matrix3 frame = plain_damping_frame(damping.model, state);
  const Matrix3 rate = frame.transpose() * gradient_of(shape, v);
  const Matrix3 strain_rate =
      in_axes(filter, 0.5 * (rate + rate.transpose()), [&](const Mat3d& e) { return filter(e); });
  const Matrix3 stress =
      2 * damping.beta * strain_rate + damping.alpha * strain_rate.trace() * Matrix3::Identity();
  const Mat3d pull =
      of(Matrix3(frame * in_axes(filter, stress, [&](const Mat3d& s) { return filter.transposed(s); })));
  Forces forces;
  for (std::size_t a = 0; a < 4; ++a) forces[a] = shape.volume * (pull * shape.gradients[a]);
  return forces;
}

}  // namespace evert::test
