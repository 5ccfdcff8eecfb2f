#pragma once
#include "evert/math/pack.hpp"

#include "filtered_run.hpp"
#include <limits>

/// Elastic and damping forces of filtered tetrahedra.
namespace evert::filtered {

/// x of J x = b for a symmetric positive semidefinite J. Where J is singular (nodes in a line or a point), so
/// is b, and x stays finite.
template <Real T>
EVERT_ALWAYS_INLINE Vec3<T> solve_semidefinite(const Mat3<T>& j, const Vec3<T>& b) {
  using Limits = std::numeric_limits<scalar_t<T>>;
  const T smallest = T(Limits::epsilon()) * trace(j) + T(Limits::min());
  const T one = T(1.0);
  const T i0 = one / max(j(0, 0), smallest);
  const T l10 = j(1, 0) * i0, l20 = j(2, 0) * i0;
  const T i1 = one / max(j(1, 1) - l10 * j(1, 0), smallest);
  const T rest = j(2, 1) - l20 * j(1, 0);
  const T l21 = rest * i1;
  const T d2 = max(j(2, 2) - l20 * j(2, 0) - l21 * rest, smallest);
  const T y1 = b[1] - l10 * b[0];
  const T y2 = b[2] - l20 * b[0] - l21 * y1;
  const T x2 = y2 / d2;
  const T x1 = y1 * i1 - l21 * x2;
  return {b[0] * i0 - l10 * x1 - l20 * x2, x1, x2};
}

/// Takes the torque off forces whose sum is zero, given for all nodes but the first: f_a −= β × r_a with
/// (Σ|r|²I − r rᵀ) β = Σ r × f, r from the centroid of the nodes. That is the smallest change, and none at
/// rest, where the stress has no torque.
template <Real T>
EVERT_ALWAYS_INLINE void remove_torque(const kernels::Edges<T, 4>& edges, kernels::Edges<T, 4>& f) {
  const Vec3<T> centroid = T(0.25) * (edges[0] + edges[1] + edges[2]);
  Vec3<T> torque = cross(edges[0], f[0]) + cross(edges[1], f[1]) + cross(edges[2], f[2]);
  Mat3<T> squares = outer(centroid, centroid);  // of the first node
  for (const auto& edge : edges) squares += outer(edge - centroid, edge - centroid);
  const Vec3<T> beta = solve_semidefinite(trace(squares) * identity<T>() - squares, torque);
  for (std::size_t a = 0; a < 3; ++a) f[a] -= cross(beta, edges[a] - centroid);
}

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
