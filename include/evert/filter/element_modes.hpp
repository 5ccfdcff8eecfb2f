#pragma once
#include "evert/core/index.hpp"
#include "evert/materials/lame.hpp"
#include "evert/math/vec3.hpp"

#include <algorithm>
#include <array>
#include <span>

/// The vibrations of one linear tetrahedron and the filter of the fast ones, in the space of strains. PHYSICS
/// 9; docs/design/modal-filter.md derives what stands here
namespace evert {

/// A linear tetrahedron at rest.
struct TetShape {
  std::array<Vec3d, 4> gradients;  ///< g_a = ∂N_a/∂X [1/m]
  double volume;                   ///< [m³]
};

/// `nodes`: local numbers of the four.
[[nodiscard]] TetShape tet_shape(std::span<const LocalIndex> nodes, std::span<const Vec3d> rest_positions);

/// Masses credited to the four nodes [kg].
using TetMasses = std::array<double, 4>;

/// The eigenvalue problem of the stiffness at rest K_e = V Bᵀ E B against the masses M*, without its six
/// rigid motions. In strains it is H = V S B M*⁻¹ Bᵀ S, S = E^½, and along the eigenvectors of Σ_a g_a g_aᵀ /
/// m_a that falls into one 3×3 problem of the three stretches and three shears.
struct ElementModes {
  Mat3d axes;           ///< these eigenvectors, as columns: a rotation
  Mat3d stretch_modes;  ///< Q of the 3×3 problem, orthonormal columns
  Vec3d stretches;      ///< its eigenvalues, squared frequencies, ascending [1/s²]
  Vec3d shears;         ///< those of the shear of the pair without axis k [1/s²]

  [[nodiscard]] double largest() const { return std::max({stretches[2], shears[0], shears[1], shears[2]}); }
  [[nodiscard]] double smallest() const { return std::min({stretches[0], shears[0], shears[1], shears[2]}); }
};

[[nodiscard]] ElementModes element_modes(const TetShape& shape, const TetMasses& masses, const Lame& lame);

/// A linear map of strains along given axes: the stretches among themselves, and each shear by a factor.
template <class T>
struct StrainMap {
  Mat3<T> stretch;  ///< on the three stretches
  Vec3<T> shear;    ///< on the shear of the pair without axis k

  /// A e; `strain` symmetric, along the axes.
  [[nodiscard]] EVERT_ALWAYS_INLINE Mat3<T> operator()(const Mat3<T>& strain) const {
    return put_together(stretch * Vec3<T>{strain(0, 0), strain(1, 1), strain(2, 2)}, strain);
  }
  /// Aᵀ s
  [[nodiscard]] EVERT_ALWAYS_INLINE Mat3<T> transposed(const Mat3<T>& stress) const {
    return put_together(transpose_times(stretch, Vec3<T>{stress(0, 0), stress(1, 1), stress(2, 2)}), stress);
  }

 private:
  [[nodiscard]] EVERT_ALWAYS_INLINE Mat3<T> put_together(const Vec3<T>& on, const Mat3<T>& tensor) const {
    const T yz = shear[0] * tensor(1, 2), xz = shear[1] * tensor(0, 2), xy = shear[2] * tensor(0, 1);
    return {{{{on[0], xy, xz}, {xy, on[1], yz}, {xz, yz, on[2]}}}};
  }
};

/// The linear map A of strains with E' = Aᵀ E A, where E' = S Q diag(min(1, limit/λ)) Qᵀ S is the elasticity
/// of the filtered element: none of its eigenvalues against the same masses exceeds the limit. Rigid motions
/// have no strain, and stay as they are.
struct StrainFilter : StrainMap<double> {
  Mat3d axes;  ///< of the strains, as columns
};

/// `limit` [1/s²] > 0; `lame` as given to element_modes. Of modes that are all below it A is the identity.
[[nodiscard]] StrainFilter strain_filter(const ElementModes& modes, const Lame& lame, double limit);

/// Row-major, x y z of node after node.
using TetMatrix = std::array<double, 144>;

/// K_e [N/m], and K'_e of the filter.
[[nodiscard]] TetMatrix element_stiffness(const TetShape& shape, const Lame& lame);
[[nodiscard]] TetMatrix element_stiffness(const TetShape& shape, const Lame& lame,
                                          const StrainFilter& filter);

/// The largest eigenvalue [1/s²] of the filtered element against any other masses.
[[nodiscard]] double largest_eigenvalue(const TetShape& shape, const TetMasses& masses, const Lame& lame,
                                        const StrainFilter& filter);

}  // namespace evert
