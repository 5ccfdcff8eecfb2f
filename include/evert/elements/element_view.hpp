#pragma once
#include "evert/math/vec3.hpp"
#include "evert/mesh/mesh.hpp"

#include <array>
#include <cstddef>
#include <span>

/// What an element is made of.
namespace evert {

/// Shape functions and quadrature of one cell type on its reference cell ξ. Nodes in VTK's order.
template <int node_total, int point_total>
struct ReferenceElement {
  static constexpr int nodes = node_total;
  static constexpr int points = point_total;
  template <class Value>
  using PerPoint = std::array<Value, point_total>;
  template <class Value>
  using PerNode = std::array<Value, node_total>;

  CellType type;
  /// The shape functions are products of those of one dimension, and so are the points: gradients can be
  /// taken axis by axis, which needs no more of the rest shape than ∂X/∂ξ at each point
  /// (kernels/tensor_product.hpp).
  bool tensor_product = false;
  PerPoint<double> weights;            ///< W of paper A, section 4; they sum to the reference volume
  PerPoint<PerNode<double>> values;    ///< N_a at each point
  PerPoint<PerNode<Vec3d>> gradients;  ///< H: ∂N_a/∂ξ at each point
};

/// No element has more; arrays of one number a node or point may have these sizes.
inline constexpr std::size_t most_nodes = 10, most_points = 8;

/// A reference element whatever its numbers of nodes and points: what set-up works with, which need not be
/// compiled once per element. Refers to the element, which must be a constant.
class ElementView {
 public:
  ElementView() = default;  ///< of no element
  template <int nodes, int points>
  constexpr ElementView(const ReferenceElement<nodes, points>& element)  // NOLINT: an element is one
      : type_(element.type),
        nodes_(nodes),
        points_(points),
        weights_(element.weights.data()),
        values_(element.values.front().data()),
        gradients_(element.gradients.front().data()) {
    static_assert(nodes <= most_nodes && points <= most_points, "raise most_nodes or most_points");
  }

  template <int nodes, int points>
  ElementView(const ReferenceElement<nodes, points>&&) = delete;  // refers to what will be gone

  [[nodiscard]] CellType type() const { return type_; }
  [[nodiscard]] std::size_t nodes() const { return nodes_; }
  [[nodiscard]] std::size_t points() const { return points_; }
  /// Of point q, and of node a there: the members of ReferenceElement.
  [[nodiscard]] double weight(std::size_t q) const { return weights_[q]; }
  [[nodiscard]] double value(std::size_t q, std::size_t a) const { return values_[q * nodes_ + a]; }
  [[nodiscard]] const Vec3d& gradient(std::size_t q, std::size_t a) const {
    return gradients_[q * nodes_ + a];
  }

 private:
  CellType type_ = CellType::tet4;
  std::size_t nodes_ = 0, points_ = 0;
  const double* weights_ = nullptr;
  const double* values_ = nullptr;
  const Vec3d* gradients_ = nullptr;
};

/// Splits a cell over its nodes for lumped masses: what each gets of the `volumes` |∂X/∂ξ| W of the points.
///
/// Row sums of the consistent mass matrix, Σ_q N_a V_q, where every N_a is positive at the points. In tet10
/// the corners would get −1/20 each. There its diagonal, Σ_q N_a² V_q, is scaled to the volume of the cell:
/// positive for any shape, and it keeps the mass.  Hinton, Rock and Zienkiewicz 1976
[[nodiscard]] std::array<double, most_nodes> lumped_volumes(const ElementView& element,
                                                            std::span<const double> volumes);

}  // namespace evert
