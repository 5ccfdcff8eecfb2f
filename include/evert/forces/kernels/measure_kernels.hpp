#pragma once
#include "evert/forces/elastic_block.hpp"
#include "evert/forces/kernels/damping_kernels.hpp"
#include "evert/forces/kernels/fibre_bound.hpp"
#include "evert/forces/kernels/fibre_direction.hpp"
#include "evert/forces/kernels/general_stress.hpp"
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

/// ψ at point i of a diagonalised run.
template <Real T, const auto& element, class Model>
EVERT_ALWAYS_INLINE T energy_density(const Model& model, const BlockArrays& block, const PointPlace& place,
                                     const PointRun<T>& run, std::size_t i) {
  if constexpr (NeedsFrames<Model>) {
    return model.energy(assemble_svd3(run.deflation(i)));
  } else if constexpr (HasFibres<Model>) {
    const Vec3<T> now = run.deformation_gradient[i] * fibre_direction<T, element>(block, place);
    return model.matrix().energy(principal_stretches(run.plane[i])) + model.fibre_energy(sqrt(dot(now, now)));
  } else {
    return model.energy(principal_stretches(run.plane[i]));
  }
}

/// The dilatations of a cell.
template <Real T, const auto& element>
struct CellDilatation {
  std::array<Dilatation<T>, element.points> at;
  T mean;  ///< over its volume
};

/// Of the cell whose points begin at `first` of a run.
template <Real T, const auto& element, HasDilatation Model>
EVERT_ALWAYS_INLINE CellDilatation<T, element> cell_dilatation(const Model& model,
                                                               const CellBatch<T, element>& batch,
                                                               const PointRun<T>& run, std::size_t first) {
  CellDilatation<T, element> of_cell;
  T sum = T(0.0), volume = T(std::numeric_limits<scalar_t<T>>::min());  // 0 in padding lanes
  for (std::size_t q = 0; q < element.points; ++q) {
    of_cell.at[q] = model.dilatation(principal_stretches(run.plane[first + q]));
    sum += batch.volume(q) * of_cell.at[q].value;
    volume += batch.volume(q);
  }
  of_cell.mean = sum / volume;
  return of_cell;
}

/// What the mean dilatation changes of the energy of the cells of a run [J].
template <Real T, const auto& element, HasDilatation Model>
EVERT_ALWAYS_INLINE T energy_of_mean_dilatation(const Model& model, const BlockArrays& block,
                                                BatchRange batches, const PointRun<T>& run) {
  T change = T(0.0);
  std::size_t first = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b, first += element.points) {
    const CellBatch<T, element> batch(block, b);
    const auto [at, mean] = cell_dilatation<T, element>(model, batch, run, first);
    for (std::size_t q = 0; q < element.points; ++q)
      change += T(0.5 * model.lame.lambda) * batch.volume(q) * (mean * mean - at[q].value * at[q].value);
  }
  return change;
}

/// Elastic energy of any model [J].
template <Real T, const auto& element, class Model>
EVERT_ALWAYS_INLINE double sum_of_energy(const Model& model, const BlockArrays& block, const double* x,
                                         BatchRange batches) {
  double sum = 0;  // of many cells: floats would not do
  for_each_run<T, element>(block, x, batches, [&](PointRun<T>& run, BatchRange piece, std::size_t points) {
    diagonalize(run, points);
    T of_run = T(0.0);
    for (std::size_t i = 0; i < points; ++i) {
      const PointPlace place = place_of<element>(piece, i);
      const CellBatch<T, element> batch(block, place.batch);
      of_run += batch.volume(place.q) * energy_density<T, element>(model, block, place, run, i);
    }
    if constexpr (element.points > 1 && HasDilatation<Model>) {
      if (block.mean_dilatation) of_run += energy_of_mean_dilatation<T, element>(model, block, piece, run);
    }
    sum += sum_of_lanes(of_run);
  });
  return sum;
}

/// See ElasticBlock::energy.
template <Real T, const auto& element, class Model>
double energy(const BlockArrays& block, const Material& material, const double* x, BatchRange batches) {
  return sum_of_energy<T, element>(model_of<Model>(material), block, x, batches);
}

/// The smallest signed principal stretch; 0 where it is zero to the rounding of the largest, whose sign is of
/// no meaning.
template <Real T>
EVERT_ALWAYS_INLINE T smallest_stretch(const PlaneRemainder<T>& plane) {
  const Vec3<T> sigma = principal_stretches(plane);
  const T smallest = min(min(sigma[0], sigma[1]), sigma[2]);
  const T largest = max(max(sigma[0], sigma[1]), sigma[2]);
  return select(abs(smallest) < T(8 * std::numeric_limits<scalar_t<T>>::epsilon()) * largest, T(0.0),
                smallest);
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
  return abs(determinant_of_f) <= T(16 * std::numeric_limits<scalar_t<T>>::epsilon()) * square * sqrt(square);
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

/// ‖sym A‖².
template <Real T>
EVERT_ALWAYS_INLINE T symmetric_square(const Mat3<T>& a) {
  const Mat3<T> symmetric = T(0.5) * (a + transpose(a));
  return contract(symmetric, symmetric);
}

/// An upper bound of ‖sym(QᵀḞ)‖² over the points of a batch, Q = U Vᵀ. Of rotated damping it is the value
/// itself, from what the operator keeps (‖sym(QᵀḞ)‖ = ‖sym(ḞQᵀ)‖); else ‖Ḟ‖², which counts rotation too.
template <Real T, const auto& element, DampingModel damping>
EVERT_ALWAYS_INLINE T strain_rate_bound(const BlockArrays& block, LocalIndex b, const double* v) {
  const CellBatch<T, element> batch(block, b);
  const DampingState<T, element, damping> state(block, b);
  const auto edges = batch.edges_of(v);
  T fastest_squared = T(0.0);
  if constexpr (keeps_rotated_gradients<element, damping>) {
    state.rotated_shape().field_gradients(edges, [&](std::size_t q, const Mat3<T>& scaled_rate) {
      const T volume =
          max(batch.volume(q), T(std::numeric_limits<scalar_t<T>>::min()));  // 0 in padding lanes
      fastest_squared = max(fastest_squared, symmetric_square(scaled_rate) / volume);
    });
  } else {
    batch.shape.field_gradients(edges, [&](std::size_t q, const Mat3<T>& rate) {
      if constexpr (damping == DampingModel::rotated) {
        fastest_squared = max(fastest_squared, symmetric_square(transpose_times(state.frame(q), rate)));
      } else {
        fastest_squared = max(fastest_squared, contract(rate, rate));
      }
    });
  }
  return fastest_squared;
}

/// ‖S‖² with S = sym(UᵀḞV), whose diagonal is dσ/dt, and its entry ij divided by √(g_i g_j), g = max(1, |σ|):
/// the rate of strain where compressed, of logarithmic strain where stretched.
template <Real T>
EVERT_ALWAYS_INLINE T relative_strain_rate_squared(const Svd3<T>& f, const Mat3<T>& rate) {
  const Mat3<T> principal = transpose_times(f.u, rate * f.v);
  T sum = T(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const T twice = principal(i, j) + principal(j, i);
      const T stretch = max(T(1.0), abs(f.sigma[i])) * max(T(1.0), abs(f.sigma[j]));
      sum += T(i == j ? 0.25 : 0.5) * twice * twice / stretch;
    }
  }
  return sum;
}

/// The largest of these over the points of a batch.
template <Real T, const auto& element>
EVERT_STAGE T batch_strain_rate_squared(const BlockArrays& block, LocalIndex b, const double* x,
                                        const double* v) {
  std::array<Mat3<T>, element.points> deformation_gradients;
  gather_field_gradients<T, element>(block, x, {b, b + 1}, deformation_gradients.data());
  const CellBatch<T, element> batch(block, b);
  T fastest_squared = T(0.0);
  batch.shape.field_gradients(batch.edges_of(v), [&](std::size_t q, const Mat3<T>& rate) {
    fastest_squared =
        max(fastest_squared, relative_strain_rate_squared(svd3(deformation_gradients[q]), rate));
  });
  return fastest_squared;
}

/// See ElasticBlock::max_strain_rate. Stretches are looked at only where the bound exceeds what has been
/// found.
template <Real T, const auto& element, DampingModel damping>
double max_strain_rate(const BlockArrays& block, const double* x, const double* v, BatchRange batches) {
  double fastest_squared = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    if (largest_lane(strain_rate_bound<T, element, damping>(block, b, v)) > fastest_squared) {
      const T of_batch = batch_strain_rate_squared<T, element>(block, b, x, v);
      fastest_squared = std::max(fastest_squared, largest_lane(of_batch));
    }
  }
  return std::sqrt(fastest_squared);
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

/// The largest Δt for which M + Δt/2 C − Δt²/4 K has no negative direction, with λ = λ_e, τ the damping time,
/// s, r and κ the bounds of the symmetric part, of the skew part and of the whole tangent (s and κ at least
/// those at rest, since the state moves on before it is asked again).
///
/// Without damping Δt = 2/√(κλ). With it, of a motion with a share c ≤ λ of K_B: 1 + c (Δt τ/2 − Δt² s/4) −
/// Δt² r λ/4 ≥ 0. Up to Δt = 2τ/s the bracket is positive, the worst motion has c = 0, and spin alone is left
/// to limit the step; beyond, the worst has c = λ.
///
/// Damping does not see a spin, and so 2/√(rλ) is that limit. But the fast motion of a flat cell is one node
/// against its base, never a spin alone: as much of it is strain, which damping sees. With Δt ≤ τ/2k, k the
/// skew part in units of 2μ, and Δt ≤ τ/s what is left undamped is a spin of the whole base, at k·λ_spin
/// (`spin_stiffness`, RestStiffness), and half of the limit returned is safe. docs/design/time-stepping.md
/// has the proof.
template <Real T>
EVERT_ALWAYS_INLINE BatchSteps<T> stable_steps(const TangentBound<T>& bound, const T& rest_stiffness,
                                               const T& spin_stiffness, const T& time) {
  const T tiny = T(std::numeric_limits<float>::min());
  const T lambda = max(rest_stiffness, tiny);  // 0 in padding lanes
  const T undamped = T(2.0) / sqrt(max(bound.total, T(1.0)) * lambda);
  const T stretching = max(bound.stretching, T(1.0));
  const T skew = max(bound.skew, T(1e-30));
  const T free_spin = T(2.0) / sqrt(max(bound.spin, T(1e-30)) * lambda);
  const T damped_spin =
      min(min(time / skew, T(2.0) * time / stretching), T(2.0) / sqrt(skew * max(spin_stiffness, tiny)));
  const T spinning = max(free_spin, damped_spin);
  const T half_damping = T(0.5) * time * lambda;
  const T stiffness = (stretching + bound.spin) * lambda;
  const T beyond = T(2.0) * (half_damping + sqrt(half_damping * half_damping + stiffness)) / stiffness;
  const T outweighed = T(2.0) * time / stretching;
  const T damped = select(beyond > outweighed, beyond, min(outweighed, spinning));
  const auto finite = bound.total < T(unresolvable<scalar_t<T>>);
  return {undamped, select(finite, max(damped, undamped), undamped)};
}

/// How stiff the model is at point i of a diagonalised run.
template <Real T, const auto& element, class Model>
EVERT_ALWAYS_INLINE TangentBound<T> bound_at(const Model& model, const BlockArrays& block,
                                             const PointPlace& place, const PointRun<T>& run, std::size_t i) {
  if constexpr (HasFibres<Model>) {
    return tangent_bound(model.along(fibre_direction<T, element>(block, place)),
                         assemble_svd3(run.deflation(i)), element.points);
  } else {
    return tangent_bound(model, principal_stretches(run.plane[i]), element.points);
  }
}

/// The share of τ that is left at a point: C contains the square of A, and what of it the models that vanish
/// when flat have less than `rotated` is as the square of its smallest principal value.
template <Real T>
EVERT_ALWAYS_INLINE T remaining_damping(DampingModel model, const PlaneRemainder<T>& plane) {
  if (model != DampingModel::objective && model != DampingModel::blended) return T(1.0);
  T smallest = min(max(smallest_stretch(plane), T(0.0)), T(1.0));
  if (model == DampingModel::blended)
    smallest += rotated_share(principal_stretches(plane)) * (T(1.0) - smallest);
  return smallest * smallest;
}

/// See ElasticBlock::stable_step.
template <Real T, const auto& element, class Model>
StableStep stable_step(const BlockArrays& block, const Material& material, const Damping& damping,
                       const double* x, BatchRange batches) {
  const Model model = model_of<Model>(material);
  T undamped = T(std::numeric_limits<scalar_t<T>>::infinity());
  T damped = undamped;
  const Lame lame = model.lame.regular();
  if (!(lame.mu > 0)) return {lane(undamped, 0), lane(damped, 0)};  // E = 0: nothing limits the step
  const T time = T(damping_time(damping, lame));
  for_each_run<T, element>(block, x, batches, [&](PointRun<T>& run, BatchRange piece, std::size_t points) {
    diagonalize(run, points);
    for (std::size_t i = 0; i < points; ++i) {
      const PointPlace place = place_of<element>(piece, i);
      const auto first_lane = static_cast<std::size_t>(place.batch) * lanes_v<T>;
      const T stiffness = load_floats<T>(block.rest_stiffness + first_lane);
      const T spin_stiffness = load_floats<T>(block.spin_stiffness + first_lane);
      const T credited = time * remaining_damping(damping.model, run.plane[i]);
      const BatchSteps<T> steps = stable_steps(bound_at<T, element>(model, block, place, run, i), stiffness,
                                               spin_stiffness, credited);
      undamped = min(undamped, steps.undamped);
      damped = min(damped, steps.damped);
    }
  });
  return {smallest_lane(undamped), smallest_lane(damped)};
}

}  // namespace evert::kernels
