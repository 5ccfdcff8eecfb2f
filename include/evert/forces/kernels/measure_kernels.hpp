#pragma once
#include "evert/forces/elastic_block.hpp"
#include "evert/forces/kernels/point_run.hpp"
#include "evert/forces/kernels/tangent_bound.hpp"

#include <limits>

/// What is asked of a block between steps: energy, inversion, the stable step, the rate of strain.
namespace evert::kernels {

template <Real T>
EVERT_ALWAYS_INLINE double sum_of_lanes(const T& x) {
  double sum = 0;
  for (std::size_t l = 0; l < lanes_v<T>; ++l) sum += lane(x, l);
  return sum;
}

template <Real T>
EVERT_ALWAYS_INLINE double smallest_lane(const T& x) {
  double smallest = lane(x, 0);
  for (std::size_t l = 1; l < lanes_v<T>; ++l) smallest = lane(x, l) < smallest ? lane(x, l) : smallest;
  return smallest;
}

template <Real T>
EVERT_ALWAYS_INLINE double largest_lane(const T& x) {
  return -smallest_lane(-x);
}

/// See ElasticBlock::energy.
template <Real T, const auto& element, class Model>
double energy(const BlockArrays& block, const Material& material, const double* x, BatchRange batches) {
  const Model model = model_of<Model>(material);
  T sum = T(0.0);
  for_each_run<T, element>(block, x, batches, [&](PointRun<T>& run, BatchRange piece, std::size_t points) {
    diagonalize(run, points);
    for (std::size_t i = 0; i < points; ++i) {
      const CellBatch<T, element> batch(block, piece.begin + static_cast<LocalIndex>(i / batch.points));
      sum += batch.volume(i % batch.points) * model.energy(principal_stretches(run.plane[i]));
    }
  });
  return sum_of_lanes(sum);
}

/// The smallest signed principal stretch; 0 where it is zero to the rounding of the largest, whose sign is of
/// no meaning.
template <Real T>
EVERT_ALWAYS_INLINE T smallest_stretch(const PlaneRemainder<T>& plane) {
  const Vec3<T> sigma = principal_stretches(plane);
  const T smallest = min(min(sigma[0], sigma[1]), sigma[2]);
  const T largest = max(max(sigma[0], sigma[1]), sigma[2]);
  return select(abs(smallest) < T(8 * std::numeric_limits<double>::epsilon()) * largest, T(0.0), smallest);
}

/// See ElasticBlock::min_stretch.
template <Real T, const auto& element>
void min_stretch(const BlockArrays& block, const double* x, double* per_cell, BatchRange batches) {
  for_each_run<T, element>(block, x, batches, [&](PointRun<T>& run, BatchRange piece, std::size_t points) {
    diagonalize(run, points);
    for (LocalIndex b = piece.begin; b < piece.end; ++b) {
      const auto first = static_cast<std::size_t>(b - piece.begin) * element.points;
      T smallest = smallest_stretch(run.plane[first]);
      for (std::size_t q = 1; q < element.points; ++q) {
        smallest = min(smallest, smallest_stretch(run.plane[first + q]));
      }
      for (std::size_t l = 0; l < lanes_v<T>; ++l) {
        const LocalIndex cell = block.cell_of_lane[static_cast<std::size_t>(b) * lanes_v<T> + l];
        if (cell >= 0) per_cell[cell] = lane(smallest, l);
      }
    }
  });
}

/// True where rounding could have given det F its sign.
template <Real T>
EVERT_ALWAYS_INLINE mask_t<T> determinant_is_uncertain(const Mat3<T>& f, const T& determinant_of_f) {
  const T square = contract(f, f);
  return abs(determinant_of_f) <= T(16 * std::numeric_limits<double>::epsilon()) * square * sqrt(square);
}

/// See ElasticBlock::inverted_points. The sign of det F tells, but for runs with a point that is flat to
/// rounding.
template <Real T, const auto& element>
LocalIndex inverted_points(const BlockArrays& block, const double* x, BatchRange batches) {
  LocalIndex count = 0;
  const auto count_negative = [&](const T& values) {
    for (std::size_t l = 0; l < lanes_v<T>; ++l) count += lane(values, l) < 0 ? 1 : 0;
  };
  for_each_run<T, element>(
      block, x, batches, [&](PointRun<T>& run, BatchRange /*piece*/, std::size_t points) {
        std::array<T, PointRun<T>::capacity> determinants;
        bool uncertain = false;
        for (std::size_t i = 0; i < points; ++i) {
          determinants[i] = determinant(run.deformation_gradient[i]);
          uncertain =
              uncertain || any(determinant_is_uncertain(run.deformation_gradient[i], determinants[i]));
        }
        if (uncertain) diagonalize(run, points);
        for (std::size_t i = 0; i < points; ++i) {
          count_negative(uncertain ? smallest_stretch(run.plane[i]) : determinants[i]);
        }
      });
  return count;
}

/// See ElasticBlock::max_strain_rate: the Frobenius norm of sym(QᵀḞ), whose diagonal in the principal frame
/// is dσ/dt.
template <Real T, const auto& element>
double max_strain_rate(const BlockArrays& block, const double* x, const double* v, BatchRange batches) {
  T fastest_squared = T(0.0);
  for_each_run<T, element>(block, x, batches, [&](PointRun<T>& run, BatchRange piece, std::size_t points) {
    std::array<Mat3<T>, PointRun<T>::capacity> rates;
    gather_field_gradients<T, element>(block, v, piece, rates.data());
    diagonalize(run, points);
    for (std::size_t i = 0; i < points; ++i) {
      const Mat3<T> rate = transpose_times(polar_rotation(run.left[i], run.plane[i], run.right[i]), rates[i]);
      const Mat3<T> stretching = T(0.5) * (rate + transpose(rate));
      fastest_squared = max(fastest_squared, contract(stretching, stretching));
    }
  });
  return std::sqrt(largest_lane(fastest_squared));
}

/// The damping time τ = min(β/μ, α/λ) that a point is credited with, of the element's own damping and
/// elasticity.
inline double damping_time(const Damping& damping, const Lame& lame) {
  if (damping.model == DampingModel::none) return 0;
  const double shear = damping.beta / lame.mu;
  return lame.lambda > 0 ? std::min(shear, damping.alpha / lame.lambda) : shear;
}

/// The stable steps of one batch: the smallest over its points.
template <Real T>
struct BatchSteps {
  T undamped, damped;
};

/// With κ the tangent bound (at least that at rest, since the state moves on before it is asked again), λ =
/// λ_e, τ the damping time: 2/√(κλ) without damping; with it the largest Δt with 1 + Δt/2 τλ − Δt²/4 κλ ≥ 0,
/// but not beyond the limit of the skew part, which has no damping.
template <Real T>
EVERT_ALWAYS_INLINE BatchSteps<T> stable_steps(const TangentBound<T>& bound, const T& rest_stiffness,
                                               const T& time) {
  const T lambda = max(rest_stiffness, T(1e-200));  // 0 in padding lanes
  const T stiffness = max(bound.total, T(1.0)) * lambda;
  const T half_damping = T(0.5) * time * lambda;
  const T damped = T(2.0) * (half_damping + sqrt(half_damping * half_damping + stiffness)) / stiffness;
  const T spinning = T(2.0) / sqrt(max(bound.spin, T(1e-30)) * lambda);
  const T undamped = T(2.0) / sqrt(stiffness);
  return {undamped, max(min(damped, spinning), undamped)};
}

/// See ElasticBlock::stable_step.
template <Real T, const auto& element, class Model>
StableStep stable_step(const BlockArrays& block, const Material& material, const Damping& damping,
                       const double* x, BatchRange batches) {
  const Model model = model_of<Model>(material);
  T undamped = T(std::numeric_limits<double>::infinity());
  T damped = undamped;
  if (!(model.lame.mu > 0)) return {lane(undamped, 0), lane(damped, 0)};  // E = 0: nothing limits the step
  const T time = T(damping_time(damping, model.lame));
  for_each_run<T, element>(block, x, batches, [&](PointRun<T>& run, BatchRange piece, std::size_t points) {
    diagonalize(run, points);
    for (std::size_t i = 0; i < points; ++i) {
      const auto batch = static_cast<std::size_t>(piece.begin) + i / element.points;
      const T stiffness = load<T>(block.rest_stiffness + batch * lanes_v<T>);
      const Vec3<T> sigma = principal_stretches(run.plane[i]);
      T credited = time;
      if (damping.model == DampingModel::objective) {
        // Vanishes when flat: scaled by the smallest stretch squared, like its operator.
        const T remaining = min(max(smallest_stretch(run.plane[i]), T(0.0)), T(1.0));
        credited *= remaining * remaining;
      }
      const BatchSteps<T> steps = stable_steps(tangent_bound(model, sigma), stiffness, credited);
      undamped = min(undamped, steps.undamped);
      damped = min(damped, steps.damped);
    }
  });
  return {smallest_lane(undamped), smallest_lane(damped)};
}

}  // namespace evert::kernels
