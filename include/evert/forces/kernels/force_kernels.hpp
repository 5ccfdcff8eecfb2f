#pragma once
#include "evert/forces/kernels/damping_kernels.hpp"
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

/// f −= G = U P̂ Vᵀ B_m.  paper A, eq. (2)
template <Real T, const auto& element>
EVERT_STAGE void nodal_force_stage(const BlockArrays& block, BatchRange batches, const PointRun<T>& run,
                                   double* f) {
  std::size_t first = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b, first += element.points) {
    const CellBatch<T, element> batch(block, b);
    const auto forces = batch.shape.nodal_sums([&](std::size_t q) {
      const std::size_t i = first + q;
      return isotropic_tensor(run.left[i], run.plane[i], run.right[i], run.principal[i]);
    });
    scatter_balanced<T, element.nodes>(forces, f, batch.nodes);
  }
}

/// See ElasticBlock::update.
template <Real T, const auto& element, class Model, DampingModel damping>
void update(const BlockArrays& block, const Material& material, const double* x, double* f,
            BatchRange batches) {
  const Model model = model_of<Model>(material);
  for_each_run<T, element>(block, x, batches, [&](PointRun<T>& run, BatchRange piece, std::size_t points) {
    diagonalize(run, points);
    principal_stress_stage<T, element>(model, block, piece, run);
    nodal_force_stage<T, element>(block, piece, run, f);
    if constexpr (damping != DampingModel::none) keep_damping_state<T, element, damping>(block, piece, run);
  });
}

}  // namespace evert::kernels
