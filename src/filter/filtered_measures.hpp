#pragma once
#include "evert/forces/kernels/measure_kernels.hpp"
#include "evert/forces/kernels/tangent_bound.hpp"

#include "filtered_run.hpp"

/// What is asked of filtered tetrahedra between steps.
namespace evert::filtered {

/// See ElasticBlock::energy: Σ V ψ(S̃).
template <Real T, class Model>
double energy(const BlockArrays& block, const Material& material, const double* x, BatchRange batches) {
  const Model model = kernels::model_of<Model>(material);
  double sum = 0;
  for_each_run<T>(block, x, batches, [&](Run<T>& run, BatchRange piece, std::size_t points) {
    strain_stage(block, piece, run);
    find_strain_axes(run, points);
    T of_run = T(0.0);
    for (std::size_t i = 0; i < points; ++i) {
      const Batch<T> batch(block, piece.begin + static_cast<LocalIndex>(i));
      of_run += batch.volume() * model.energy(filtered_stretches(run, i));
    }
    sum += kernels::sum_of_lanes(of_run);
  });
  return sum;
}

/// Calls visit(cell, smallest stretch) for every cell.
template <Real T, class Visit>
EVERT_ALWAYS_INLINE void for_each_smallest_stretch(const BlockArrays& block, const double* x,
                                                   BatchRange batches, Visit&& visit) {
  for_each_run<T>(block, x, batches, [&](Run<T>& run, BatchRange piece, std::size_t points) {
    const LocalIndex* cells = block.cell_of_lane + static_cast<std::size_t>(piece.begin) * lanes_v<T>;
    for (std::size_t i = 0; i < points; ++i, cells += lanes_v<T>) {
      const T smallest = kernels::smallest_stretch(run.plane[i]);
      for (std::size_t l = 0; l < lanes_v<T>; ++l)
        if (cells[l] >= 0) visit(cells[l], lane(smallest, l));
    }
  });
}

/// See ElasticBlock::min_stretch.
template <Real T>
void min_stretch(const BlockArrays& block, const double* x, double* per_cell, BatchRange batches) {
  for_each_smallest_stretch<T>(block, x, batches,
                               [&](LocalIndex cell, double stretch) { per_cell[cell] = stretch; });
}

/// See ElasticBlock::inverted_points.
template <Real T>
LocalIndex inverted_cells(const BlockArrays& block, const double* x, BatchRange batches) {
  LocalIndex count = 0;
  for_each_smallest_stretch<T>(block, x, batches,
                               [&](LocalIndex, double stretch) { count += stretch < 0 ? 1 : 0; });
  return count;
}

/// The sum of the smaller two principal stretches, at least smallest_stretch_sum.
template <Real T>
EVERT_ALWAYS_INLINE T smaller_two(const PlaneRemainder<T>& plane) {
  const Vec3<T> sigma = principal_stretches(plane);
  const T smaller = min(min(sigma[0] + sigma[1], sigma[0] + sigma[2]), sigma[1] + sigma[2]);
  return max(smaller, T(kernels::smallest_stretch_sum));
}

/// Of the eigenvalues of a cell against its shares of mass [1/s²], at most about: how much stiffer the model
/// is at S̃ than at rest, and what stress adds when the element turns. P = R σ' turns with R, whose change per
/// unit of displacement is at most |g|/(σ_i + σ_j), and taking the torque off at most doubles that.
template <Real T, class Model>
EVERT_ALWAYS_INLINE T stiffness_now(const Model& model, const BlockArrays& block, LocalIndex b,
                                    const Run<T>& run, std::size_t i, const T& stretch_sum) {
  const Batch<T> batch(block, b);
  const auto bounds = [&, from = block.bounds + static_cast<std::size_t>(b) * bound::total * lanes_v<T>](
                          std::size_t k) { return load<T>(from + k * lanes_v<T>); };
  const T stretching = kernels::tangent_bound(model, filtered_stretches(run, i), 1).stretching;
  const Mat3<T> stress = batch.filter().transposed(stress_at(model, run, i));
  const auto shape = batch.shape();
  T turned = T(0.0), turning = T(0.0);
  Vec3<T> first{T(0.0), T(0.0), T(0.0)};
  for (std::size_t node = 4; node-- > 0;) {
    const Vec3<T> g = node > 0 ? shape.gradient(0, node) : first;
    first -= g;
    const Vec3<T> pull = stress * g;
    turned += dot(pull, pull) * bounds(bound::inverse_masses + node);
    turning += dot(g, g) * bounds(bound::inverse_masses + node);
  }
  return max(stretching, T(1.0)) * bounds(bound::largest) +
         T(2.0) * batch.volume() * sqrt(turned * turning) / stretch_sum;
}

/// The largest of these; states that are not finite count as unresolvable. `material` is not without
/// stiffness.
template <Real T, class Model>
double largest_stiffness(const BlockArrays& block, const Material& material, const double* x,
                         BatchRange batches) {
  const Model model = kernels::model_of<Model>(material);
  const T unresolvable = T(kernels::unresolvable<scalar_t<T>>);
  T largest = T(0.0);
  for_each_run<T>(block, x, batches, [&](Run<T>& run, BatchRange piece, std::size_t points) {
    typename Run<T>::template PerPoint<T> stretch_sums;
    for (std::size_t i = 0; i < points; ++i) stretch_sums[i] = smaller_two(run.plane[i]);
    strain_stage(block, piece, run);
    find_strain_axes(run, points);
    for (std::size_t i = 0; i < points; ++i) {
      const T of_cell =
          stiffness_now(model, block, piece.begin + static_cast<LocalIndex>(i), run, i, stretch_sums[i]);
      largest = max(largest, select(of_cell < unresolvable, of_cell, unresolvable));
    }
  });
  return kernels::largest_lane(largest);
}

/// See ElasticBlock::max_strain_rate. Stretches are looked at only where ‖Ḟ‖ exceeds what has been found.
template <Real T>
double max_strain_rate(const BlockArrays& block, const double* x, const double* v, BatchRange batches) {
  double fastest_squared = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const Batch<T> batch(block, b);
    const Mat3<T> rate = gradient_of(batch, batch.edges_of(v));
    if (!(kernels::largest_lane(contract(rate, rate)) > fastest_squared)) continue;
    const auto svd = svd3(gradient_of(batch, batch.edges_of(x)));
    fastest_squared =
        std::max(fastest_squared, kernels::largest_lane(kernels::relative_strain_rate_squared(svd, rate)));
  }
  return std::sqrt(fastest_squared);
}

}  // namespace evert::filtered
