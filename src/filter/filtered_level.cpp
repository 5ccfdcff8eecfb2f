#include "evert/materials/fibres.hpp"

#include "filtered_forces.hpp"
#include "filtered_measures.hpp"
#include <variant>

// Compiled once per CPU level; what forces/kernels/level.cpp says of out-of-line copies holds here too.
namespace evert::filtered::EVERT_KERNEL_LEVEL {
namespace {

template <Real T, class Model>
constexpr Kernels kernels_of() {
  return {.lanes = static_cast<int>(lanes_v<T>),
          .update = update<T, Model>,
          .add_damping = add_damping<T>,
          .add_damping_diagonal = add_damping_diagonal<T>,
          .energy = energy<T, Model>,
          .min_stretch = min_stretch<T>,
          .inverted_cells = inverted_cells<T>,
          .largest_stiffness = largest_stiffness<T, Model>,
          .max_strain_rate = max_strain_rate<T>};
}

template <Real T, class... Models>
Kernels kernels_of(const std::variant<Models...>& material) {
  Kernels table{};
  const auto take_if = [&]<class Model>() {
    if constexpr (!HasFibres<Model>) {
      if (std::holds_alternative<Model>(material)) table = kernels_of<T, Model>();
    }
  };
  (take_if.template operator()<Models>(), ...);
  return table;
}

}  // namespace

Kernels find(const Material& material) { return kernels_of<Pack>(material); }

}  // namespace evert::filtered::EVERT_KERNEL_LEVEL
