#pragma once
#include "evert/math/pack.hpp"

#include "filtered_run.hpp"
#include "torque.hpp"
#include <limits>

/// Elastic and damping forces of filtered tetrahedra.
namespace evert::filtered {

/// −V P, P = R Aᵀ σ.
template <Real T>
EVERT_STAGE void turn_stress_stage(const BlockArrays& block, BatchRange batches, Run<T>& run) {
  std::size_t i = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b, ++i) {
    const Batch<T> batch(block, b);
    run.stress[i] = run.rotation[i] * (-batch.volume() * batch.filter().transposed(run.stress[i]));
  }
}

template <Real T>
EVERT_STAGE void nodal_force_stage(const BlockArrays& block, BatchRange batches, const Run<T>& run,
                                   double* f) {
  std::size_t i = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b, ++i) {
    const Batch<T> batch(block, b);
    auto forces = batch.shape().nodal_sums([&](std::size_t) { return run.stress[i]; });
    remove_torque(run.edges[i], forces);
    kernels::scatter_balanced<T, 4>(forces, f, batch.nodes);
  }
}

/// The frames that strain rates are seen from, of one batch.
template <Real T>
EVERT_ALWAYS_INLINE scalar_t<T>* frame_numbers(const BlockArrays& block, LocalIndex batch) {
  return block.damping_frames + static_cast<std::size_t>(batch) * 9 * lanes_v<T>;
}

template <Real T, DampingModel damping>
EVERT_STAGE void keep_frames_of(const BlockArrays& block, BatchRange batches, const Run<T>& run) {
  std::size_t i = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b, ++i)
    kernels::store_matrix(kernels::damping_frame<T, damping>(run, i), frame_numbers<T>(block, b));
}

template <Real T>
EVERT_ALWAYS_INLINE void keep_damping_frames(const BlockArrays& block, DampingModel damping,
                                             BatchRange batches, const Run<T>& run) {
  switch (damping) {
    case DampingModel::rotated:
      return keep_frames_of<T, DampingModel::rotated>(block, batches, run);
    case DampingModel::objective:
      return keep_frames_of<T, DampingModel::objective>(block, batches, run);
    case DampingModel::blended:
      return keep_frames_of<T, DampingModel::blended>(block, batches, run);
    case DampingModel::none:
      break;
  }
}

/// See ElasticBlock::update.
template <Real T, class Model>
void update(const BlockArrays& block, const Material& material, DampingModel damping, const double* x,
            double* f, BatchRange batches) {
  const Model model = kernels::model_of<Model>(material);
  for_each_run<T>(block, x, batches, [&](Run<T>& run, BatchRange piece, std::size_t points) {
    keep_damping_frames(block, damping, piece, run);
    strain_stage(block, piece, run);
    if constexpr (!LinearInStrain<Model>) find_strain_axes(run, points);
    stress_stage(model, run, points);
    turn_stress_stage(block, piece, run);
    nodal_force_stage(block, piece, run, f);
  });
}

/// |∂X/∂ξ| W P of the damping law at the velocity gradient `rate`, filtered on both sides: symmetric and
/// positive semidefinite as the law itself. `alpha` and `beta` contain V.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> viscous_stress(const StrainMap<T>& filter, const Mat3<T>& frame,
                                           const Mat3<T>& rate, const T& alpha, const T& beta) {
  const Mat3<T> strain_rate = filter(symmetric_part(transpose_times(frame, rate)));
  const Mat3<T> stress = (beta + beta) * strain_rate + (alpha * trace(strain_rate)) * identity<T>();
  return frame * filter.transposed(stress);
}

/// See ElasticBlock::add_damping.
template <Real T>
void add_damping(const BlockArrays& block, const Damping& damping, double factor, const double* v,
                 double* out, BatchRange batches) {
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const Batch<T> batch(block, b);
    const T volume = batch.volume();
    const Mat3<T> stress =
        viscous_stress(batch.filter(), kernels::load_matrix<T>(frame_numbers<T>(block, b)),
                       gradient_of(batch, batch.edges_of(v)), T(factor * damping.alpha) * volume,
                       T(factor * damping.beta) * volume);
    kernels::scatter_balanced<T, 4>(batch.shape().nodal_sums([&](std::size_t) { return stress; }), out,
                                    batch.nodes);
  }
}

/// See ElasticBlock::add_damping_diagonal.
template <Real T>
void add_damping_diagonal(const BlockArrays& block, const Damping& damping, double factor, double* normal,
                          double* shear, BatchRange batches) {
  const T zero = T(0.0);
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const Batch<T> batch(block, b);
    const auto filter = batch.filter();
    const auto shape = batch.shape();
    const Mat3<T> frame = kernels::load_matrix<T>(frame_numbers<T>(block, b));
    const T alpha = T(factor * damping.alpha) * batch.volume(),
            beta = T(factor * damping.beta) * batch.volume();
    Vec3<T> first{zero, zero, zero};
    for (std::size_t node = 4; node-- > 0;) {
      const Vec3<T> g = node > 0 ? shape.gradient(0, node) : first;
      first -= g;
      Mat3<T> of_node;
      for (std::size_t k = 0; k < 3; ++k) {
        Vec3<T> unit{zero, zero, zero};
        unit[k] = T(1.0);
        of_node.column[k] = viscous_stress(filter, frame, outer(unit, g), alpha, beta) * g;
      }
      const auto* nodes = batch.nodes + node * lanes_v<T>;
      kernels::add_rows<T>(normal, nodes, rows_of_lanes<T>({of_node(0, 0), of_node(1, 1), of_node(2, 2)}));
      kernels::add_rows<T>(shear, nodes, rows_of_lanes<T>({of_node(2, 1), of_node(2, 0), of_node(1, 0)}));
    }
  }
}

}  // namespace evert::filtered
