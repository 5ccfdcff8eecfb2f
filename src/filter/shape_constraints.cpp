#include "evert/filter/shape_constraints.hpp"

#include "evert/core/collective.hpp"
#include "evert/filter/shape_class.hpp"
#include "evert/math/nodal.hpp"
#include "evert/mesh/cell_geometry.hpp"

#include "nodal_sums.hpp"
#include <algorithm>
#include <set>
#include <utility>

namespace evert {
namespace {

using Edge = std::pair<GlobalIndex, GlobalIndex>;  // global node numbers, ascending

GlobalIndex global_number(const DistributedMesh& mesh, LocalIndex node) {
  return node < mesh.owned_nodes ? mesh.first_owned + node
                                 : mesh.ghost_globals[static_cast<std::size_t>(node - mesh.owned_nodes)];
}

Edge edge_of(const DistributedMesh& mesh, const ShapeConstraint& constraint) {
  return std::minmax({global_number(mesh, constraint.nodes[0]), global_number(mesh, constraint.nodes[1])});
}

double edge_violation(const ShapeConstraint& edge, std::span<const double> x, TetRow& gradient) {
  const Vec3d d = node_value(x, edge.nodes[1]) - node_value(x, edge.nodes[0]);
  gradient = {};
  gradient[1] = (1 / edge.rest) * d;
  gradient[0] = -gradient[1];
  return (dot(d, d) - edge.rest * edge.rest) / (2 * edge.rest);
}

/// h = (apex − a)·n of the face a b c with normal n; its gradient is n at the apex, and at the corners −n
/// times the barycentric coordinates of the point of the face's plane that is below the apex.
double height_violation(const ShapeConstraint& height, std::span<const double> x, TetRow& gradient) {
  const auto at = [&](std::size_t k) { return node_value(x, height.nodes[k]); };
  const Vec3d b = at(2) - at(1), c = at(3) - at(1), top = at(0) - at(1);
  const Vec3d area = cross(b, c);
  const double square = dot(area, area);
  const Vec3d normal = (1 / std::sqrt(square)) * area;
  const double of_b = dot(cross(top, c), area) / square, of_c = dot(cross(b, top), area) / square;
  gradient = {normal, -(1 - of_b - of_c) * normal, -of_b * normal, -of_c * normal};
  return dot(top, normal) - height.rest;
}

/// Collective. Drops edges that a lower rank has, too: their nodes are in use on both.
void drop_those_of_lower_ranks(const FilterProblem& problem, std::vector<ShapeConstraint>& constraints) {
  const auto& mesh = problem.mesh;
  NodalSums users(problem);
  for (const auto& constraint : constraints)
    for (const LocalIndex node : constraint.nodes)
      if (node >= 0) users.at(node, 0) = 1;
  users.share();
  const auto may_be_shared = [&](const ShapeConstraint& constraint) {
    return constraint.is_edge() && users.at(constraint.nodes[0], 0) > 1.5 &&
           users.at(constraint.nodes[1], 0) > 1.5;
  };
  std::vector<GlobalIndex> mine;
  for (const auto& constraint : constraints)
    if (may_be_shared(constraint)) {
      const auto [low, high] = edge_of(mesh, constraint);
      mine.insert(mine.end(), {low, high});
    }
  const auto ranks = static_cast<std::size_t>(size_of(mesh.comm));
  const int count = static_cast<int>(mine.size());
  std::vector<int> counts(ranks), begins(ranks);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, mesh.comm);
  for (std::size_t r = 1; r < ranks; ++r) begins[r] = begins[r - 1] + counts[r - 1];
  std::vector<GlobalIndex> all(static_cast<std::size_t>(begins.back() + counts.back()));
  MPI_Allgatherv(mine.data(), count, MPI_INT64_T, all.data(), counts.data(), begins.data(), MPI_INT64_T,
                 mesh.comm);
  std::set<Edge> of_lower;
  const auto end = static_cast<std::size_t>(begins[static_cast<std::size_t>(rank_of(mesh.comm))]);
  for (std::size_t i = 0; i < end; i += 2) of_lower.emplace(all[i], all[i + 1]);
  std::erase_if(constraints, [&](const ShapeConstraint& constraint) {
    return may_be_shared(constraint) && of_lower.contains(edge_of(mesh, constraint));
  });
}

}  // namespace

double violation(const ShapeConstraint& constraint, std::span<const double> x, TetRow& gradient) {
  return constraint.is_edge() ? edge_violation(constraint, x, gradient)
                              : height_violation(constraint, x, gradient);
}

std::vector<ShapeConstraint> shape_constraints(const FilterProblem& problem,
                                               std::span<const CellClamp> clamps) {
  const auto& mesh = problem.mesh;
  std::vector<ShapeConstraint> constraints;
  std::set<Edge> seen;
  for (std::size_t c = 0; c < problem.cells.size(); ++c) {
    if (!(clamps[c].limit > 0)) continue;
    const auto& nodes = problem.cells[c].nodes;
    std::array<Vec3d, 4> corners;
    for (std::size_t a = 0; a < 4; ++a) corners[a] = mesh.rest_positions[static_cast<std::size_t>(nodes[a])];
    const auto distances = short_distances(corners);
    for (const std::size_t e : distances.edges) {
      const auto [a, b] = edges_of_tet[e];
      ShapeConstraint edge{{nodes[a], nodes[b], -1, -1}, norm(corners[b] - corners[a])};
      if (seen.insert(edge_of(mesh, edge)).second) constraints.push_back(edge);
    }
    if (distances.apex) {
      const std::size_t a = *distances.apex;
      // The face as it is seen from the apex, so that the height is positive.
      constexpr std::array<std::array<std::size_t, 3>, 4> below{{{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};
      ShapeConstraint height{{nodes[a], nodes[below[a][0]], nodes[below[a][1]], nodes[below[a][2]]}, 0};
      const Vec3d origin = corners[below[a][0]];
      const Vec3d area = cross(corners[below[a][1]] - origin, corners[below[a][2]] - origin);
      height.rest = dot(corners[a] - origin, area) / norm(area);
      constraints.push_back(height);
    }
  }
  if (size_of(mesh.comm) > 1) drop_those_of_lower_ranks(problem, constraints);
  return constraints;
}

}  // namespace evert
