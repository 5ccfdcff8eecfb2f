#pragma once
#include "evert/forces/kernels/point_run.hpp"
#include "evert/materials/damping.hpp"

/// The damping operator C(x), matrix-free.  paper A, section 6.2; PHYSICS 4
///
/// Both models are one law, P = A (β (ḞᵀA + AᵀḞ) + α tr(AᵀḞ) I), with A = Q = U Vᵀ (rotated) or A = F
/// (objective). Kept of each point is A, 9 numbers. Where A is a rotation less work remains when the shape
/// gradients h_a = √V Q ∂N_a/∂X are kept instead: with L = Σ v_a h_aᵀ the damping force on node a is −S h_a,
/// S = β (L + Lᵀ) + α tr(L) I. Of a tetrahedron, and of a tensor product, whose (∂X/∂ξ)⁻¹ is turned and
/// scaled (W = √V (∂X/∂ξ)⁻¹ Qᵀ), these are 9 numbers too.
namespace evert::kernels {

template <const auto& element, DampingModel damping>
inline constexpr bool keeps_rotated_gradients =
    damping == DampingModel::rotated&& ShapeGradients<double, element>::numbers_per_point <= 9;

/// Numbers kept per batch and lane.
template <const auto& element, DampingModel damping>
inline constexpr std::size_t damping_numbers =
    damping == DampingModel::none ? 0
                                  : element.points*(keeps_rotated_gradients<element, damping>
                                                        ? ShapeGradients<double, element>::numbers_per_point
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
  EVERT_ALWAYS_INLINE ShapeGradients<T, element> rotated_shape() const { return {numbers}; }
  /// A of point q.
  EVERT_ALWAYS_INLINE Mat3<T> frame(std::size_t q) const { return load_matrix<T>(numbers + 9 * q * lanes); }
  EVERT_ALWAYS_INLINE void store_frame(std::size_t q, const Mat3<T>& frame) const {
    store_matrix(frame, numbers + 9 * q * lanes);
  }
};

/// The gradients that the stresses of damping_stress_stage act on.
template <Real T, const auto& element, DampingModel damping>
EVERT_ALWAYS_INLINE ShapeGradients<T, element> damping_shape(const BlockArrays& block, LocalIndex batch) {
  if constexpr (keeps_rotated_gradients<element, damping>) {
    return DampingState<T, element, damping>(block, batch).rotated_shape();
  } else {
    return CellBatch<T, element>(block, batch).shape;
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
      const Mat3<T> frame = damping == DampingModel::rotated
                                ? polar_rotation(run.left[i], run.plane[i], run.right[i])
                                : run.deformation_gradient[i];
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

/// V (β (h hᵀ + |g|² A Aᵀ) + α h hᵀ), h = A g: the diagonal block of the node with gradient g.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> damping_block(const Vec3<T>& h, const T& gradient_squared,
                                          const Mat3<T>& frame_square, const T& alpha, const T& beta) {
  return outer((alpha + beta) * h, h) + (beta * gradient_squared) * frame_square;
}

/// See ElasticBlock::add_damping_diagonal.
template <Real T, const auto& element, DampingModel damping>
void add_damping_diagonal(const BlockArrays& block, const Damping& coefficients, double factor,
                          double* blocks, BatchRange batches) {
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const CellBatch<T, element> batch(block, b);
    const DampingState<T, element, damping> state(block, b);
    const auto shape = damping_shape<T, element, damping>(block, b);
    std::array<Mat3<T>, element.nodes> diagonal{};
    for (std::size_t q = 0; q < batch.points; ++q) {
      T weight = T(factor);
      Mat3<T> frame = identity<T>();
      if constexpr (!keeps_rotated_gradients<element, damping>) {
        weight *= batch.volume(q);
        frame = state.frame(q);
      }
      const Mat3<T> frame_square = times_transpose(frame, frame);
      const T alpha = weight * T(coefficients.alpha), beta = weight * T(coefficients.beta);
      Vec3<T> first{T(0.0), T(0.0), T(0.0)};
      const auto add = [&](std::size_t a, const Vec3<T>& gradient) {
        diagonal[a] += damping_block(frame * gradient, dot(gradient, gradient), frame_square, alpha, beta);
      };
      for (std::size_t a = 1; a < element.nodes; ++a) {
        const Vec3<T> gradient = shape.gradient(q, a);
        first -= gradient;
        add(a, gradient);
      }
      add(0, first);
    }
    for (std::size_t a = 0; a < element.nodes; ++a) {
      for (std::size_t j = 0; j < 3; ++j) {
        add_rows<T, 9>(blocks + 3 * j, batch.nodes + a * lanes_v<T>, rows_of_lanes<T>(diagonal[a].column[j]));
      }
    }
  }
}

}  // namespace evert::kernels
