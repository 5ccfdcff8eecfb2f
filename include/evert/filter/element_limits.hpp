#pragma once
#include "evert/forces/elastic_forces.hpp"

#include <span>
#include <vector>

namespace evert {

/// The largest eigenvalues of the stiffness K_e of every cell of this rank by itself [1/s²], and what they
/// say of the whole body.  paper B, section 3
struct ElementLimits {
  /// One more than any cell's: per entry of DistributedMesh::cells, per cell.
  using PerCell = std::vector<std::vector<double>>;

  PerCell own_masses;    ///< λ(K_e, M_e), M_e the cell's own lumped masses, ρV/4 a node of a tetrahedron
  PerCell nodal_masses;  ///< λ(K_e, M̃_e), M̃_e the masses of its nodes
  double largest_of_own = 0;    ///< over all ranks: eq. (9), an upper bound of λmax(M⁻¹K)
  double largest_of_nodal = 0;  ///< over all ranks: eq. (8), a lower bound
  int most_cells_a_node = 0;    ///< over all ranks: n; n times the lower bound of eq. (8) is its upper one
};

/// Collective. Of K_e at `x` [m], whose ghosts are brought up to date. The bounds are rigorous: Σ_e M_e = M,
/// and Σ_e M̃_e ≤ n M. (That of eq. (9) is a special case of splitting the masses of the nodes over their
/// cells, and not the heuristic that the paper takes it for.)  PHYSICS 9
[[nodiscard]] ElementLimits element_limits(const DistributedMesh& mesh, const ElasticForces& elastic,
                                           NodeField& x);

}  // namespace evert
