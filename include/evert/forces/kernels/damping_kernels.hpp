#pragma once
#include "evert/forces/kernels/point_run.hpp"
#include "evert/materials/damping.hpp"

/// The damping operator C(x), matrix-free.  paper A, section 6.2; PHYSICS 4
///
/// All models are one law, P = A (β (ḞᵀA + AᵀḞ) + α tr(AᵀḞ) I), with A = Q = U Vᵀ (rotated), A = F
/// (objective) or A = F + w (Q − F) (blended). Kept of each point is A, 9 numbers. Where A is a rotation less
/// work remains when the shape gradients h_a = √V Q ∂N_a/∂X are kept instead: with L = Σ v_a h_aᵀ the damping
/// force on node a is −S h_a, S = β (L + Lᵀ) + α tr(L) I. Of a tetrahedron, and of a tensor product, whose
/// (∂X/∂ξ)⁻¹ is turned and scaled (W = √V (∂X/∂ξ)⁻¹ Qᵀ), these are 9 numbers too.
namespace evert::kernels {

template <const auto& element, DampingModel damping>
inline constexpr bool keeps_rotated_gradients =
    damping == DampingModel::rotated&& TurnedGradients<double, element>::layout.numbers() <= 9;

/// Numbers kept per batch and lane.
template <const auto& element, DampingModel damping>
inline constexpr std::size_t damping_numbers =
    damping == DampingModel::none ? 0
                                  : element.points*(keeps_rotated_gradients<element, damping>
                                                        ? TurnedGradients<double, element>::layout.numbers()
                                                        : 9);

/// The state of one batch.
template <Real T, const auto& element, DampingModel damping>
struct DampingState {
  static constexpr std::size_t lanes = lanes_v<T>;
  scalar_t<T>* numbers;

  EVERT_ALWAYS_INLINE DampingState(const BlockArrays& block, LocalIndex batch)
      : numbers(static_cast<scalar_t<T>*>(block.damping_state) +
                static_cast<std::size_t>(batch) * damping_numbers<element, damping> * lanes) {}

  /// h_a, to be used like the gradients at rest.
  EVERT_ALWAYS_INLINE TurnedGradients<T, element> rotated_shape() const { return {{numbers}}; }
  /// A of point q.
  EVERT_ALWAYS_INLINE Mat3<T> frame(std::size_t q) const { return load_matrix<T>(numbers + 9 * q * lanes); }
  EVERT_ALWAYS_INLINE void store_frame(std::size_t q, const Mat3<T>& frame) const {
    store_matrix(frame, numbers + 9 * q * lanes);
  }
};

/// The gradients that the stresses of damping_stress_stage act on.
template <Real T, const auto& element, DampingModel damping>
EVERT_ALWAYS_INLINE auto damping_shape(const BlockArrays& block, LocalIndex batch) {
  if constexpr (keeps_rotated_gradients<element, damping>) {
    return DampingState<T, element, damping>(block, batch).rotated_shape();
  } else {
    return CellBatch<T, element>(block, batch).shape;
  }
}

/// A of point i of a diagonalised run. That of `blended` is written as what is added to F, so that nothing
/// is where w = 0.
template <Real T, DampingModel damping>
EVERT_ALWAYS_INLINE Mat3<T> damping_frame(const PointRun<T>& run, std::size_t i) {
  if constexpr (damping == DampingModel::rotated) {
    return polar_rotation(run.left[i], run.plane[i], run.right[i]);
  } else if constexpr (damping == DampingModel::objective) {
    return run.deformation_gradient[i];
  } else {
    const Vec3<T> sigma = principal_stretches(run.plane[i]);
    const Vec3<T> to_rotation = rotated_share(sigma) * (Vec3<T>{T(1.0), T(1.0), T(1.0)} - sigma);
    return run.deformation_gradient[i] +
           isotropic_tensor(run.left[i], run.plane[i], run.right[i], to_rotation);
  }
}

/// Keeps what C(x) needs of a diagonalised run.
template <Real T, const auto& element, DampingModel damping>
EVERT_STAGE void keep_damping_state(const BlockArrays& block, BatchRange batches, const PointRun<T>& run) {
  std::size_t i = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const CellBatch<T, element> batch(block, b);
    const DampingState<T, element, damping> state(block, b);
    for (std::size_t q = 0; q < batch.points; ++q, ++i) {
      const Mat3<T> frame = damping_frame<T, damping>(run, i);
      if constexpr (keeps_rotated_gradients<element, damping>) {
        batch.shape.store_transformed(q, sqrt(batch.volume(q)) * frame, state.numbers);
      } else {
        state.store_frame(q, frame);
      }
    }
  }
}

/// β (L + Lᵀ) + α tr(L) I.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> viscous_stress(const Mat3<T>& l, const T& alpha, const T& beta) {
  const T pressure = alpha * trace(l);
  const T s01 = beta * (l(0, 1) + l(1, 0)), s02 = beta * (l(0, 2) + l(2, 0)),
          s12 = beta * (l(1, 2) + l(2, 1));
  const T two_beta = beta + beta;
  return {{{{two_beta * l(0, 0) + pressure, s01, s02},
            {s01, two_beta * l(1, 1) + pressure, s12},
            {s02, s12, two_beta * l(2, 2) + pressure}}}};
}

/// S of every point, or |∂X/∂ξ| W P, at the velocities v.
template <Real T, const auto& element, DampingModel damping>
EVERT_STAGE void damping_stress_stage(const BlockArrays& block, const double* v, double alpha, double beta,
                                      BatchRange batches, Mat3<T>* stresses) {
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const CellBatch<T, element> batch(block, b);
    const DampingState<T, element, damping> state(block, b);
    const auto edges = batch.edges_of(v);
    if constexpr (keeps_rotated_gradients<element, damping>) {
      state.rotated_shape().field_gradients(edges, [&](std::size_t q, const Mat3<T>& l) {
        stresses[q] = viscous_stress(l, T(alpha), T(beta));
      });
    } else {
      batch.shape.field_gradients(edges, [&](std::size_t q, const Mat3<T>& gradient) {
        const Mat3<T> frame = state.frame(q);
        const Mat3<T> rate = transpose_times(frame, gradient);
        stresses[q] = batch.volume(q) * (frame * viscous_stress(rate, T(alpha), T(beta)));
      });
    }
    stresses += element.points;
  }
}

/// Adds their forces on the nodes.
template <Real T, const auto& element, DampingModel damping>
EVERT_STAGE void damping_force_stage(const BlockArrays& block, BatchRange batches, const Mat3<T>* stresses,
                                     double* out) {
  for (LocalIndex b = batches.begin; b < batches.end; ++b, stresses += element.points) {
    const CellBatch<T, element> batch(block, b);
    const auto shape = damping_shape<T, element, damping>(block, b);
    const auto forces = shape.nodal_sums([&](std::size_t q) { return stresses[q]; });
    scatter_balanced<T, element.nodes>(forces, out, batch.nodes);
  }
}

/// See ElasticBlock::add_damping.
template <Real T, const auto& element, DampingModel damping>
void add_damping(const BlockArrays& block, const Damping& coefficients, double factor, const double* v,
                 double* out, BatchRange batches) {
  typename PointRun<T>::template PerPoint<Mat3<T>> stresses;
  for_each_piece<T, element>(batches, [&](BatchRange piece) {
    damping_stress_stage<T, element, damping>(block, v, factor * coefficients.alpha,
                                              factor * coefficients.beta, piece, stresses.data());
    damping_force_stage<T, element, damping>(block, piece, stresses.data(), out);
  });
}

/// A symmetric matrix in Voigt's order: xx yy zz, yz xz xy.
template <Real T>
struct SymmetricBlock {
  Vec3<T> normal{T(0.0), T(0.0), T(0.0)};
  Vec3<T> shear{T(0.0), T(0.0), T(0.0)};

  /// += c h hᵀ
  EVERT_ALWAYS_INLINE void add_square(const T& c, const Vec3<T>& h) {
    const Vec3<T> ch = c * h;
    normal += Vec3<T>{ch[0] * h[0], ch[1] * h[1], ch[2] * h[2]};
    shear += Vec3<T>{ch[1] * h[2], ch[0] * h[2], ch[0] * h[1]};
  }
};

/// Adds the diagonal block of the node with gradient g at a point, V (β (h hᵀ + |g|² A Aᵀ) + α h hᵀ), h = A
/// g. `alpha` and `beta` contain V.
template <Real T>
EVERT_ALWAYS_INLINE void add_damping_block(const Vec3<T>& g, const Mat3<T>& frame, const T& alpha,
                                           const T& beta, SymmetricBlock<T>& block) {
  block.add_square(alpha + beta, frame * g);
  const T weight = beta * dot(g, g);
  for (std::size_t j = 0; j < 3; ++j) block.add_square(weight, frame.column[j]);
}

/// The same where the frame is a rotation and in the gradient h already: A Aᵀ is the identity.
template <Real T>
EVERT_ALWAYS_INLINE void add_rotated_block(const Vec3<T>& h, const T& alpha, const T& beta,
                                           SymmetricBlock<T>& block) {
  block.add_square(alpha + beta, h);
  const T weight = beta * dot(h, h);
  block.normal += Vec3<T>{weight, weight, weight};
}

/// See ElasticBlock::add_damping_diagonal.
template <Real T, const auto& element, DampingModel damping>
void add_damping_diagonal(const BlockArrays& block, const Damping& coefficients, double factor,
                          double* normal, double* shear, BatchRange batches) {
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const CellBatch<T, element> batch(block, b);
    const DampingState<T, element, damping> state(block, b);
    const auto shape = damping_shape<T, element, damping>(block, b);
    std::array<SymmetricBlock<T>, element.nodes> diagonal{};
    for (std::size_t q = 0; q < batch.points; ++q) {
      const auto for_each_gradient = [&](auto&& add) {
        Vec3<T> first{T(0.0), T(0.0), T(0.0)};
        for (std::size_t a = 1; a < element.nodes; ++a) {
          const Vec3<T> gradient = shape.gradient(q, a);
          first -= gradient;
          add(gradient, diagonal[a]);
        }
        add(first, diagonal[0]);
      };
      const T alpha = T(factor * coefficients.alpha), beta = T(factor * coefficients.beta);
      if constexpr (keeps_rotated_gradients<element, damping>) {
        for_each_gradient([&](const Vec3<T>& h, SymmetricBlock<T>& of_node) {
          add_rotated_block(h, alpha, beta, of_node);
        });
      } else {
        const Mat3<T> frame = state.frame(q);
        const T volume = batch.volume(q);
        for_each_gradient([&](const Vec3<T>& g, SymmetricBlock<T>& of_node) {
          add_damping_block(g, frame, volume * alpha, volume * beta, of_node);
        });
      }
    }
    for (std::size_t a = 0; a < element.nodes; ++a) {
      const auto* nodes = batch.nodes + a * lanes_v<T>;
      add_rows<T>(normal, nodes, rows_of_lanes<T>(diagonal[a].normal));
      add_rows<T>(shear, nodes, rows_of_lanes<T>(diagonal[a].shear));
    }
  }
}

}  // namespace evert::kernels
