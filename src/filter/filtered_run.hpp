#pragma once
#include "evert/elements/reference_element.hpp"
#include "evert/filter/element_modes.hpp"
#include "evert/forces/kernels/damping_kernels.hpp"
#include "evert/forces/kernels/node_access.hpp"
#include "evert/forces/kernels/point_run.hpp"
#include "evert/forces/kernels/shape_gradients.hpp"
#include "evert/materials/rotated_linear.hpp"
#include "evert/math/symmetric_axes.hpp"

#include "filtered_kernels.hpp"
#include <concepts>

/// Filtered tetrahedra on their way from positions to the stress at the filtered strain, a pack of cells at a
/// time and in stages, as forces/kernels does it for the others.  PHYSICS 9; docs/design/modal-filter.md
namespace evert::filtered {

/// A cell per lane.
template <Real T>
struct Batch {
  static constexpr std::size_t lanes = lanes_v<T>;
  const LocalIndex* nodes;
  const scalar_t<T>* numbers;

  EVERT_ALWAYS_INLINE Batch(const BlockArrays& block, LocalIndex batch)
      : nodes(block.nodes + static_cast<std::size_t>(batch) * 4 * lanes),
        numbers(block.cells + static_cast<std::size_t>(batch) * number::total * lanes) {}

  EVERT_ALWAYS_INLINE kernels::TurnedGradients<T, tet4> shape() const {
    return {{numbers + number::gradients * lanes}};
  }
  EVERT_ALWAYS_INLINE StrainMap<T> filter() const {
    return {kernels::load_matrix<T>(numbers + number::stretch * lanes),
            kernels::load_vector<T>(numbers + number::shear * lanes)};
  }
  EVERT_ALWAYS_INLINE T volume() const { return load<T>(numbers + number::volume * lanes); }
  EVERT_ALWAYS_INLINE kernels::Edges<T, 4> edges_of(const double* field) const {
    return kernels::gather_edges<T, 4>(field, nodes);
  }
};

/// The gradient of a field of which these are the differences to the first node.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> gradient_of(const Batch<T>& batch, const kernels::Edges<T, 4>& edges) {
  Mat3<T> gradient;
  batch.shape().field_gradients(edges, [&](std::size_t, const Mat3<T>& of_point) { gradient = of_point; });
  return gradient;
}

template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> symmetric_part(const Mat3<T>& a) {
  return T(0.5) * (a + transpose(a));
}

/// The stages of the base class serve twice, for F and then for the strain.
template <Real T>
struct Run : kernels::PointRun<T> {
  template <class Value>
  using PerPoint = typename kernels::PointRun<T>::template PerPoint<Value>;
  PerPoint<kernels::Edges<T, 4>> edges;      ///< x_a − x_0
  PerPoint<Mat3<T>> rotation;                ///< R
  PerPoint<Mat3<T>> strain;                  ///< A (S − I)
  PerPoint<SymmetricPlane<T>> strain_plane;  ///< of it, in the frame `right`
  PerPoint<Mat3<T>> stress;                  ///< σ(S̃), then −V P
};

template <Real T>
EVERT_STAGE void gather_stage(const BlockArrays& block, const double* x, BatchRange batches, Run<T>& run) {
  std::size_t i = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b, ++i) {
    const Batch<T> batch(block, b);
    run.edges[i] = batch.edges_of(x);
    run.deformation_gradient[i] = gradient_of(batch, run.edges[i]);
  }
}

/// A (S − I), S = RᵀF, of a diagonalised run.
template <Real T>
EVERT_STAGE void strain_stage(const BlockArrays& block, BatchRange batches, Run<T>& run) {
  std::size_t i = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b, ++i) {
    run.rotation[i] = polar_rotation(run.left[i], run.plane[i], run.right[i]);
    const Mat3<T> stretch = symmetric_part(transpose_times(run.rotation[i], run.deformation_gradient[i]));
    run.strain[i] = Batch<T>(block, b).filter()(stretch - identity<T>());
  }
}

template <Real T>
EVERT_STAGE void strain_deviator_stage(Run<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) run.square[i] = deviator(run.strain[i]);
}

template <Real T>
EVERT_STAGE void strain_plane_stage(Run<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) run.strain_plane[i] = symmetric_plane(run.strain[i], run.right[i]);
}

/// The principal axes of the filtered strain; those of F are gone afterwards.
template <Real T>
EVERT_ALWAYS_INLINE void find_strain_axes(Run<T>& run, std::size_t points) {
  strain_deviator_stage(run, points);
  root_stage<T>(run, points);
  right_direction_stage<T>(run, points);
  frame_stage(run.direction.data(), run.right.data(), points);
  strain_plane_stage(run, points);
}

/// Of S̃ = I + A (S − I), signed: several may be negative, and every model is extended to that.
template <Real T>
EVERT_ALWAYS_INLINE Vec3<T> filtered_stretches(const Run<T>& run, std::size_t i) {
  return principal_values(run.strain_plane[i]) + Vec3<T>{T(1.0), T(1.0), T(1.0)};
}

/// Its stress is linear in the strain, whose axes need not be known.
template <class Model>
concept LinearInStrain = std::same_as<Model, RotatedLinear>;

template <Real T, class Model>
EVERT_ALWAYS_INLINE Mat3<T> stress_at(const Model& model, const Run<T>& run, std::size_t i) {
  if constexpr (LinearInStrain<Model>) {
    const T pressure = T(model.lame.lambda) * trace(run.strain[i]);
    return T(2 * model.lame.mu) * run.strain[i] + pressure * identity<T>();
  } else {
    return symmetric_tensor(run.right[i], run.strain_plane[i],
                            model.principal_stress(filtered_stretches(run, i)));
  }
}

/// σ(S̃)
template <Real T, class Model>
EVERT_STAGE void stress_stage(const Model& model, Run<T>& run, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) run.stress[i] = stress_at(model, run, i);
}

/// Calls `work(run, piece, points)` for pieces of `batches` that fill a run, F diagonalised.
template <Real T, class Work>
EVERT_ALWAYS_INLINE void for_each_run(const BlockArrays& block, const double* x, BatchRange batches,
                                      Work&& work) {
  Run<T> run;
  kernels::for_each_piece<T, tet4>(batches, [&](BatchRange piece) {
    const auto points = static_cast<std::size_t>(piece.end - piece.begin);
    gather_stage(block, x, piece, run);
    diagonalize<T>(run, points);
    work(run, piece, points);
  });
}

}  // namespace evert::filtered
