#pragma once
#include "evert/core/petsc.hpp"

namespace evert {

/// Collective. An upper bound of the largest |eigenvalue| of the symmetric matrix `a` of 3×3 blocks, rigorous
/// however few the `iterations` are; about ten bring it to within some per cent of the eigenvalue.  PHYSICS 9
///
/// With N the matrix of the spectral norms of the blocks, ‖A u‖ ≤ ‖N |u|‖ and so |λ|max(A) ≤ ρ(N), since u
/// and N |u| may be compared node by node. N has no negative entry: by Collatz and Wielandt ρ(N) ≤ max_i
/// (Nx)_i / x_i for every positive x, which iterations x ← N x make smaller and smaller.
[[nodiscard]] double collatz_wielandt_bound(Mat a, int iterations = 10);

/// The same with the x of the last iteration, one a node: after many it is large where the bound is not met.
struct CollatzWielandt {
  double bound = 0;
  VecHandle weights;
};
[[nodiscard]] CollatzWielandt collatz_wielandt(Mat a, int iterations);

/// The step [s] at which explicit elastic forces without damping stop being stable, of a squared frequency
/// [1/s²]: 2/ω; infinity for 0 and below.
[[nodiscard]] double step_limit(double squared_frequency);

}  // namespace evert
