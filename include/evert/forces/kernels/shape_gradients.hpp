#pragma once
#include "evert/elements/reference_element.hpp"
#include "evert/elements/shape_layout.hpp"
#include "evert/forces/kernels/node_access.hpp"
#include "evert/forces/kernels/tensor_product.hpp"

#include <array>
#include <cstddef>
#include <type_traits>

/// What a batch stores to take gradients with: of each quadrature point either the shape gradients
/// themselves, or, where the shape functions are tensor products, the inverse of ∂X/∂ξ. Both are used the
/// same way. The damping operator keeps, of many points, the same vectors once more, turned and scaled
/// (damping_kernels.hpp); then they are never triangular.
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

/// The vectors v_j of the points of a batch. Components that are zero by the layout are neither read nor
/// multiplied by.
template <Real T, std::size_t vector_total, bool triangular>
struct ShapeVectors {
  static constexpr ShapeLayout layout{vector_total, triangular};
  template <class Value>
  using PerVector = std::array<Value, vector_total>;

  const scalar_t<T>* numbers;  ///< [point][number][lane]

  /// Component i < layout.components(j) of vector j at point q.
  EVERT_ALWAYS_INLINE T component(std::size_t q, std::size_t j, std::size_t i) const {
    return load<T>(numbers + (q * layout.numbers() + layout.begin(j) + i) * lanes_v<T>);
  }
  EVERT_ALWAYS_INLINE Vec3<T> vector(std::size_t q, std::size_t j) const {
    Vec3<T> v{T(0.0), T(0.0), T(0.0)};
    for (std::size_t i = 0; i < layout.components(j); ++i) v[i] = component(q, j, i);
    return v;
  }

  /// m v_j
  EVERT_ALWAYS_INLINE Vec3<T> times_vector(const Mat3<T>& m, std::size_t q, std::size_t j) const {
    Vec3<T> product = component(q, j, 0) * m.column[0];
    for (std::size_t i = 1; i < layout.components(j); ++i) product += component(q, j, i) * m.column[i];
    return product;
  }

  /// Σ_j a_j ⊗ v_j
  EVERT_ALWAYS_INLINE Mat3<T> sum_of_outer(const PerVector<Vec3<T>>& a, std::size_t q) const {
    Mat3<T> sum;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t first = triangular ? i : 0;  // with a component i
      sum.column[i] = component(q, first, i) * a[first];
      for (std::size_t j = first + 1; j < vector_total; ++j) sum.column[i] += component(q, j, i) * a[j];
    }
    return sum;
  }

  /// Writes m v_j of point q to `to`, in the full layout.
  EVERT_ALWAYS_INLINE void store_transformed(std::size_t q, const Mat3<T>& m, scalar_t<T>* to) const {
    for (std::size_t j = 0; j < vector_total; ++j)
      store_vector(times_vector(m, q, j), to + 3 * (q * vector_total + j) * lanes_v<T>);
  }
};

/// Any element: ∂N_a/∂X of every node but the first, whose gradient is minus their sum.
template <Real T, const auto& element, bool triangular>
struct NodeGradients : ShapeVectors<T, element.nodes - 1, triangular> {
  /// ∂N_a/∂X at point q, for a ≥ 1.
  EVERT_ALWAYS_INLINE Vec3<T> gradient(std::size_t q, std::size_t a) const { return this->vector(q, a - 1); }

  /// `take(q, gradient)` for the gradient of a nodal field at every point: F of positions, Ḟ of velocities.
  /// paper A, section 4: F = D_s H (D_m H)⁻¹
  template <class Take>
  EVERT_ALWAYS_INLINE void field_gradients(const Edges<T, element.nodes>& edges, Take&& take) const {
    for (std::size_t q = 0; q < element.points; ++q) take(q, this->sum_of_outer(edges, q));
  }

  /// Σ_q P_q ∂N_a/∂X for every node but the first, with `stress_at(q)` = |∂X/∂ξ| W P_q: the blocks G = Σ P
  /// B_m of paper A, section 4.
  template <class StressAt>
  EVERT_ALWAYS_INLINE Edges<T, element.nodes> nodal_sums(StressAt&& stress_at) const {
    Edges<T, element.nodes> sums;
    const Mat3<T> first = stress_at(0);
    for (std::size_t j = 0; j + 1 < element.nodes; ++j) sums[j] = this->times_vector(first, 0, j);
    for (std::size_t q = 1; q < element.points; ++q) {
      const Mat3<T> stress = stress_at(q);
      for (std::size_t j = 0; j + 1 < element.nodes; ++j) sums[j] += this->times_vector(stress, q, j);
    }
    return sums;
  }
};

/// Elements with ReferenceElement::tensor_product: the rows of (∂X/∂ξ)⁻¹ at each point.
template <Real T, const auto& element, bool triangular>
struct InverseJacobians : ShapeVectors<T, 3, triangular> {
  static_assert(element.nodes == 8 && element.points == 8);
  /// A copy of its own for each CPU level (docs/design/cpu-levels.md).
  static constexpr auto reference_gradients_of_nodes = element.gradients;

  /// As those of NodeGradients.
  EVERT_ALWAYS_INLINE Vec3<T> gradient(std::size_t q, std::size_t a) const {
    const Vec3d& of_reference = reference_gradients_of_nodes[q][a];
    Vec3<T> sum = T(scalar_t<T>(of_reference[0])) * this->vector(q, 0);
    for (std::size_t k = 1; k < 3; ++k) sum += T(scalar_t<T>(of_reference[k])) * this->vector(q, k);
    return sum;
  }

  template <class Take>
  EVERT_ALWAYS_INLINE void field_gradients(const Edges<T, 8>& edges, Take&& take) const {
    std::array<std::array<Vec3<T>, 3>, 8> of_reference;  // [point][axis of ξ]
    for (std::size_t i = 0; i < 3; ++i) {
      Cube<T> component;
      component[0] = T(0.0);
      for (std::size_t a = 1; a < 8; ++a) component[cube_corner_of_node[a]] = edges[a - 1][i];
      reference_gradients(
          component, [&](std::size_t q, std::size_t k, const T& slope) { of_reference[q][k][i] = slope; });
    }
    for (std::size_t q = 0; q < 8; ++q) take(q, this->sum_of_outer(of_reference[q], q));
  }

  template <class StressAt>
  EVERT_ALWAYS_INLINE Edges<T, 8> nodal_sums(StressAt&& stress_at) const {
    std::array<std::array<Vec3<T>, 3>, 8> on_reference;  // [point][axis of ξ]
    for (std::size_t q = 0; q < 8; ++q) {
      const Mat3<T> stress = stress_at(q);
      for (std::size_t k = 0; k < 3; ++k) on_reference[q][k] = this->times_vector(stress, q, k);
    }
    Edges<T, 8> sums;
    for (std::size_t i = 0; i < 3; ++i) {
      const Cube<T> component = reference_gradients_transposed<T>(
          [&](std::size_t q, std::size_t k) { return on_reference[q][k][i]; });
      for (std::size_t a = 1; a < 8; ++a) sums[a - 1][i] = component[cube_corner_of_node[a]];
    }
    return sums;
  }
};

template <Real T, const auto& element, bool triangular>
using ShapeGradients = std::conditional_t<element.tensor_product, InverseJacobians<T, element, triangular>,
                                          NodeGradients<T, element, triangular>>;
/// Of the rest shape.
template <Real T, const auto& element>
using RestGradients = ShapeGradients<T, element,
                                     rest_layout(element.tensor_product ? ShapeData::inverse_jacobian
                                                                        : ShapeData::node_gradients,
                                                 element.nodes, element.points)
                                         .triangular>;
/// Of the rest shape, turned and scaled.
template <Real T, const auto& element>
using TurnedGradients = ShapeGradients<T, element, false>;

}  // namespace evert::kernels
