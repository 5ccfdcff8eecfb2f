#pragma once
#include "evert/forces/kernels/damping_kernels.hpp"
#include "evert/forces/kernels/fibre_direction.hpp"
#include "evert/forces/kernels/general_stress.hpp"
#include "evert/forces/kernels/plastic_flow.hpp"
#include "evert/forces/kernels/point_run.hpp"
#include "evert/materials/material.hpp"

/// Elastic forces.  paper A, sections 4-6
namespace evert::kernels {

/// −|∂X/∂ξ| W P̂(F̂) at every point of the run.  paper A, section 6
template <Real T, const auto& element, class Model>
EVERT_STAGE void principal_stress_stage(const Model& model, const BlockArrays& block, BatchRange batches,
                                        PointRun<T>& run) {
  std::size_t i = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const CellBatch<T, element> batch(block, b);
    for (std::size_t q = 0; q < batch.points; ++q, ++i) {
      const Vec3<T> stress = model.principal_stress(principal_stretches(run.plane[i]));
      run.principal[i] = -batch.volume(q) * stress;
    }
  }
}

/// The mean over a cell in the place of the dilatation of each of its points, in its stress.
template <Real T, const auto& element, HasDilatation Model>
EVERT_STAGE void mean_dilatation_stage(const Model& model, const BlockArrays& block, BatchRange batches,
                                       PointRun<T>& run) {
  std::size_t first = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b, first += element.points) {
    const CellBatch<T, element> batch(block, b);
    const auto [at, mean] = cell_dilatation<T, element>(model, batch, run, first);
    for (std::size_t q = 0; q < element.points; ++q)
      run.principal[first + q] +=
          (-batch.volume(q) * T(model.lame.lambda) * (mean - at[q].value)) * at[q].slope;
  }
}

/// f −= G = P B_m, with `stress_of(i)` = −|∂X/∂ξ| W P at point i of the run.
template <Real T, const auto& element, class StressOf>
EVERT_ALWAYS_INLINE void add_nodal_forces(const BlockArrays& block, BatchRange batches, double* f,
                                          StressOf&& stress_of) {
  std::size_t first = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b, first += element.points) {
    const CellBatch<T, element> batch(block, b);
    const auto forces = batch.shape.nodal_sums([&](std::size_t q) { return stress_of(first + q); });
    scatter_balanced<T, element.nodes>(forces, f, batch.nodes);
  }
}

/// f −= G = U P̂ Vᵀ B_m, P̂ diagonal.  paper A, eq. (2)
template <Real T, const auto& element>
EVERT_STAGE void nodal_force_stage(const BlockArrays& block, BatchRange batches, const PointRun<T>& run,
                                   double* f) {
  add_nodal_forces<T, element>(block, batches, f, [&](std::size_t i) {
    return isotropic_tensor(run.left[i], run.plane[i], run.right[i], run.principal[i]);
  });
}

/// −|∂X/∂ξ| W (T/Λ) F a of the fibres at every point of the run.  PHYSICS 3
template <Real T, const auto& element, class Model>
EVERT_STAGE void fibre_stage(const Model& model, const BlockArrays& block, BatchRange batches,
                             const PointRun<T>& run, Vec3<T>* pulls) {
  std::size_t i = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const CellBatch<T, element> batch(block, b);
    for (std::size_t q = 0; q < batch.points; ++q, ++i) {
      const Vec3<T> now = run.deformation_gradient[i] * fibre_direction<T, element>(block, {b, q});
      pulls[i] = (-batch.volume(q) * fibre_pull(model, sqrt(dot(now, now)))) * now;
    }
  }
}

/// The same with fibres: P = U P̂ Vᵀ + (T/Λ) F a aᵀ.
template <Real T, const auto& element>
EVERT_STAGE void nodal_force_stage(const BlockArrays& block, BatchRange batches, const PointRun<T>& run,
                                   const Vec3<T>* pulls, double* f) {
  add_nodal_forces<T, element>(block, batches, f, [&](std::size_t i) {
    return isotropic_tensor(run.left[i], run.plane[i], run.right[i], run.principal[i]) +
           outer(pulls[i], fibre_direction<T, element>(block, place_of<element>(batches, i)));
  });
}

/// The same of stresses that are there already.
template <Real T, const auto& element>
EVERT_STAGE void nodal_force_stage(const BlockArrays& block, BatchRange batches, const FramedRun<T>& framed,
                                   double* f) {
  add_nodal_forces<T, element>(block, batches, f, [&](std::size_t i) { return framed.stress[i]; });
}

/// Elastic forces of any model, once what yields has flown; keeps what the damping needs.
template <Real T, const auto& element, DampingModel damping, class Model>
EVERT_ALWAYS_INLINE void add_forces(const Model& model, const BlockArrays& block, const double* x, double* f,
                                    BatchRange batches) {
  for_each_run<T, element>(block, x, batches, [&](PointRun<T>& run, BatchRange piece, std::size_t points) {
    diagonalize(run, points);
    if constexpr (MayFlow<T, Model>) {
      if (block.plastic != nullptr) flow<T, element>(model, block, x, piece, run, points);
    }
    if constexpr (NeedsFrames<Model>) {
      FramedRun<T> framed;
      general_stress<T, element>(model, block, piece, run, points, framed);
      nodal_force_stage<T, element>(block, piece, framed, f);
    } else if constexpr (HasFibres<Model>) {
      typename PointRun<T>::template PerPoint<Vec3<T>> pulls;
      principal_stress_stage<T, element>(model.matrix(), block, piece, run);
      fibre_stage<T, element>(model, block, piece, run, pulls.data());
      nodal_force_stage<T, element>(block, piece, run, pulls.data(), f);
    } else {
      principal_stress_stage<T, element>(model, block, piece, run);
      if constexpr (element.points > 1 && HasDilatation<Model>) {
        if (block.mean_dilatation) mean_dilatation_stage<T, element>(model, block, piece, run);
      }
      nodal_force_stage<T, element>(block, piece, run, f);
    }
    if constexpr (damping != DampingModel::none) keep_damping_state<T, element, damping>(block, piece, run);
  });
}

/// See ElasticBlock::update.
template <Real T, const auto& element, class Model, DampingModel damping>
void update(const BlockArrays& block, const Material& material, const double* x, double* f,
            BatchRange batches) {
  add_forces<T, element, damping>(model_of<Model>(material), block, x, f, batches);
}

}  // namespace evert::kernels
