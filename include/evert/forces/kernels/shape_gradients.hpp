#pragma once
#include "evert/elements/reference_element.hpp"
#include "evert/forces/kernels/node_access.hpp"
#include "evert/forces/kernels/tensor_product.hpp"

#include <array>
#include <cstddef>
#include <type_traits>

/// What a batch stores to take gradients with: of each quadrature point either the shape gradients
/// themselves, or, where the shape functions are tensor products, the inverse of ∂X/∂ξ. Both are used the
/// same way; and the damping operator keeps, of many points, the same numbers once more, turned and scaled
/// (damping_kernels.hpp).
namespace evert::kernels {

template <Real T>
EVERT_ALWAYS_INLINE void store_vector(const Vec3<T>& v, scalar_t<T>* to) {
  for (std::size_t i = 0; i < 3; ++i) store(v[i], to + i * lanes_v<T>);
}
template <Real T>
EVERT_ALWAYS_INLINE Vec3<T> load_vector(const scalar_t<T>* from) {
  return {load<T>(from), load<T>(from + lanes_v<T>), load<T>(from + 2 * lanes_v<T>)};
}

template <Real T>
EVERT_ALWAYS_INLINE void store_matrix(const Mat3<T>& m, scalar_t<T>* to) {
  for (std::size_t j = 0; j < 3; ++j) store_vector(m.column[j], to + 3 * j * lanes_v<T>);
}
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> load_matrix(const scalar_t<T>* from) {
  return {load_vector<T>(from), load_vector<T>(from + 3 * lanes_v<T>), load_vector<T>(from + 6 * lanes_v<T>)};
}

/// Any element: ∂N_a/∂X of every node but the first, whose gradient is minus their sum.
template <Real T, const auto& element>
struct NodeGradients {
  static constexpr std::size_t numbers_per_point = 3 * (element.nodes - 1);

  const scalar_t<T>* numbers;  ///< [point][node 1…][3][lane]

  /// ∂N_a/∂X at point q, for a ≥ 1.
  EVERT_ALWAYS_INLINE Vec3<T> gradient(std::size_t q, std::size_t a) const {
    return load_vector<T>(numbers + (q * numbers_per_point + 3 * (a - 1)) * lanes_v<T>);
  }

  /// Writes the gradients at point q, each multiplied by `m`, to `to`, laid out like `numbers`.
  EVERT_ALWAYS_INLINE void store_transformed(std::size_t q, const Mat3<T>& m, scalar_t<T>* to) const {
    for (std::size_t a = 1; a < element.nodes; ++a) {
      store_vector(m * gradient(q, a), to + (q * numbers_per_point + 3 * (a - 1)) * lanes_v<T>);
    }
  }

  /// `take(q, gradient)` for the gradient of a nodal field at every point: F of positions, Ḟ of velocities.
  /// paper A, section 4: F = D_s H (D_m H)⁻¹
  template <class Take>
  EVERT_ALWAYS_INLINE void field_gradients(const Edges<T, element.nodes>& edges, Take&& take) const {
    for (std::size_t q = 0; q < element.points; ++q) {
      Mat3<T> sum = outer(edges[0], gradient(q, 1));
      for (std::size_t a = 2; a < element.nodes; ++a) sum += outer(edges[a - 1], gradient(q, a));
      take(q, sum);
    }
  }

  /// Σ_q P_q ∂N_a/∂X for every node but the first, with `stress_at(q)` = |∂X/∂ξ| W P_q: the blocks G = Σ P
  /// B_m of paper A, section 4.
  template <class StressAt>
  EVERT_ALWAYS_INLINE Edges<T, element.nodes> nodal_sums(StressAt&& stress_at) const {
    Edges<T, element.nodes> sums;
    const Mat3<T> first = stress_at(0);
    for (std::size_t a = 1; a < element.nodes; ++a) sums[a - 1] = first * gradient(0, a);
    for (std::size_t q = 1; q < element.points; ++q) {
      const Mat3<T> stress = stress_at(q);
      for (std::size_t a = 1; a < element.nodes; ++a) sums[a - 1] += stress * gradient(q, a);
    }
    return sums;
  }
};

/// Elements with ReferenceElement::tensor_product: (∂X/∂ξ)⁻¹ at each point.
template <Real T, const auto& element>
struct InverseJacobians {
  static_assert(element.nodes == 8 && element.points == 8);
  static constexpr std::size_t numbers_per_point = 9;
  /// A copy of its own for each CPU level (docs/design/cpu-levels.md).
  static constexpr auto reference_gradients_of_nodes = element.gradients;

  const scalar_t<T>* numbers;  ///< [point][column][row][lane]

  EVERT_ALWAYS_INLINE Mat3<T> inverse_jacobian(std::size_t q) const {
    return load_matrix<T>(numbers + q * numbers_per_point * lanes_v<T>);
  }

  /// As those of NodeGradients.
  EVERT_ALWAYS_INLINE Vec3<T> gradient(std::size_t q, std::size_t a) const {
    const Vec3d& of_reference = reference_gradients_of_nodes[q][a];
    return transpose_times(inverse_jacobian(q),
                           Vec3<T>{T(scalar_t<T>(of_reference[0])), T(scalar_t<T>(of_reference[1])),
                                   T(scalar_t<T>(of_reference[2]))});
  }

  EVERT_ALWAYS_INLINE void store_transformed(std::size_t q, const Mat3<T>& m, scalar_t<T>* to) const {
    store_matrix(times_transpose(inverse_jacobian(q), m), to + q * numbers_per_point * lanes_v<T>);
  }

  template <class Take>
  EVERT_ALWAYS_INLINE void field_gradients(const Edges<T, 8>& edges, Take&& take) const {
    std::array<Mat3<T>, 8> of_reference;
    for (std::size_t i = 0; i < 3; ++i) {
      Cube<T> component;
      component[0] = T(0.0);
      for (std::size_t a = 1; a < 8; ++a) component[cube_corner_of_node[a]] = edges[a - 1][i];
      reference_gradients(
          component, [&](std::size_t q, std::size_t k, const T& slope) { of_reference[q](i, k) = slope; });
    }
    for (std::size_t q = 0; q < 8; ++q) take(q, of_reference[q] * inverse_jacobian(q));
  }

  template <class StressAt>
  EVERT_ALWAYS_INLINE Edges<T, 8> nodal_sums(StressAt&& stress_at) const {
    std::array<Mat3<T>, 8> on_reference;
    for (std::size_t q = 0; q < 8; ++q) on_reference[q] = times_transpose(stress_at(q), inverse_jacobian(q));
    Edges<T, 8> sums;
    for (std::size_t i = 0; i < 3; ++i) {
      const Cube<T> component = reference_gradients_transposed<T>(
          [&](std::size_t q, std::size_t k) { return on_reference[q](i, k); });
      for (std::size_t a = 1; a < 8; ++a) sums[a - 1][i] = component[cube_corner_of_node[a]];
    }
    return sums;
  }
};

template <Real T, const auto& element>
using ShapeGradients =
    std::conditional_t<element.tensor_product, InverseJacobians<T, element>, NodeGradients<T, element>>;

}  // namespace evert::kernels
