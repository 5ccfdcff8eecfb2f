#pragma once
#include "evert/elements/reference_element.hpp"
#include "evert/forces/kernels/elastic_kernels.hpp"
#include "evert/forces/kernels/force_kernels.hpp"

/// The path of models that need U and V, on an element that is no tensor product: neo-Hookean and hex8, which
/// need neither, taken the long way.
namespace evert::bench {

template <Real T>
void general_update(const kernels::BlockArrays& block, const Material& material, const double* x, double* f,
                    BatchRange batches) {
  const kernels::InFrames<NeoHookean> model{kernels::model_of<NeoHookean>(material)};
  kernels::add_forces<T, hex8_by_gradients, DampingModel::none>(model, block, x, f, batches);
}

/// Forces only.
template <Real T>
kernels::ElasticKernels general_hex_kernels() {
  return {.lanes = static_cast<int>(lanes_v<T>),
          .shape_data = ShapeData::node_gradients,
          .update = general_update<T>};
}

}  // namespace evert::bench
