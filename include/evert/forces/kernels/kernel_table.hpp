#pragma once
#include "evert/forces/kernels/damping_kernels.hpp"
#include "evert/forces/kernels/elastic_kernels.hpp"
#include "evert/forces/kernels/force_kernels.hpp"
#include "evert/forces/kernels/measure_kernels.hpp"

#include <type_traits>

/// Picks the instances of the kernel templates. For inclusion by the sources compiled once per CPU level, and
/// by tests that run the kernels on scalars.
namespace evert::kernels {

/// What the kernels expect of the arrays they are given; no function yet.
template <Real T, const auto& element, class Model, DampingModel damping>
constexpr ElasticKernels needs_of_kernels() {
  return {
      .lanes = static_cast<int>(lanes_v<T>),
      .precision = std::is_same_v<scalar_t<T>, float> ? Precision::mixed : Precision::full,
      .shape_data = element.tensor_product ? ShapeData::inverse_jacobian : ShapeData::node_gradients,
      .damping_numbers = static_cast<int>(damping_numbers<element, damping>),
      .rotated_gradients = keeps_rotated_gradients<element, damping>,
      .fibres = HasFibres<Model>,
  };
}

template <Real T, const auto& element, class Model, DampingModel damping>
constexpr ElasticKernels kernels_of() {
  auto table = needs_of_kernels<T, element, Model, damping>();
  table.update = update<T, element, Model, damping>;
  table.energy = energy<T, element, Model>;
  table.min_stretch = min_stretch<T, element>;
  table.inverted_points = inverted_points<T, element>;
  table.stable_step = stable_step<T, element, Model>;
  table.max_strain_rate = max_strain_rate<T, element, damping>;
  if constexpr (MayFlow<T, Model>) table.deform_shapes = deform_shapes<T, element>;
  if constexpr (damping != DampingModel::none) {
    table.add_damping = add_damping<T, element, damping>;
    table.add_damping_diagonal = add_damping_diagonal<T, element, damping>;
  }
  return table;
}

/// `kernels.template operator()<Model, damping>()` for the model that the material holds, and the damping.
template <class... Models, class Kernels>
ElasticKernels with_model(const std::variant<Models...>& material, DampingModel damping, Kernels&& kernels) {
  ElasticKernels table;
  const auto take = [&]<class Model>() {
    switch (damping) {
      case DampingModel::rotated:
        return kernels.template operator()<Model, DampingModel::rotated>();
      case DampingModel::objective:
        return kernels.template operator()<Model, DampingModel::objective>();
      case DampingModel::blended:
        return kernels.template operator()<Model, DampingModel::blended>();
      case DampingModel::none:
        break;
    }
    return kernels.template operator()<Model, DampingModel::none>();
  };
  const auto take_if = [&]<class Model>() {
    if (std::holds_alternative<Model>(material)) table = take.template operator()<Model>();
  };
  (take_if.template operator()<Models>(), ...);
  return table;
}

template <Real T, const auto& element>
ElasticKernels kernels_of(const Material& material, DampingModel damping) {
  return with_model(material, damping,
                    []<class Model, DampingModel kind>() { return kernels_of<T, element, Model, kind>(); });
}

/// `lanes` is 0 in the answer for a type without an element.
template <Real T, const auto&... elements>
ElasticKernels kernels_of(ReferenceElements<elements...> /*all*/, CellType type, const Material& material,
                          DampingModel damping) {
  ElasticKernels table;
  const auto take_if = [&]<const auto & element>() {
    if (element.type == type) table = kernels_of<T, element>(material, damping);
  };
  (take_if.template operator()<elements>(), ...);
  return table;
}

}  // namespace evert::kernels
