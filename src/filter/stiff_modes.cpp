#include "evert/filter/stiff_modes.hpp"

#include "evert/core/error.hpp"
#include "evert/forces/kernels/tangent_bound.hpp"
#include "evert/math/nodal.hpp"
#include "evert/math/svd3.hpp"

#include "torque.hpp"
#include <algorithm>
#include <cmath>

namespace evert {
namespace {

Mat3d turned(const Mat3d& axes, const Mat3d& tensor) { return axes * times_transpose(tensor, axes); }

/// s_k = S q_k of the stretches, and √μ (e_i e_jᵀ + e_j e_iᵀ) of the shears, along the axes of the modes:
/// then V Σ (s_k : ε)² is uᵀ K u.
std::vector<StiffMode> modes_above(const ElementModes& modes, const FilterCell& cell, double limit) {
  std::vector<StiffMode> above;
  const auto add = [&](const Mat3d& along_axes, double eigenvalue) {
    if (eigenvalue > limit)
      above.push_back({turned(modes.axes, along_axes), cell.shape.volume * (1 - limit / eigenvalue)});
  };
  const double shear = std::sqrt(2 * cell.lame.mu);
  const double bulk = std::sqrt(2 * cell.lame.mu + 3 * cell.lame.lambda);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& q = modes.stretch_modes.column[k];
    const double mean = (q[0] + q[1] + q[2]) / 3;
    add(diagonal(shear * q + ((bulk - shear) * mean) * Vec3d{1, 1, 1}), modes.stretches[k]);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    Mat3d of_pair{};
    of_pair((k + 1) % 3, (k + 2) % 3) = of_pair((k + 2) % 3, (k + 1) % 3) = std::sqrt(cell.lame.mu);
    add(of_pair, modes.shears[k]);
  }
  return above;
}

}  // namespace

std::vector<StiffCell> stiff_cells(const FilterProblem& problem, std::span<const CellClamp> clamps) {
  std::vector<StiffCell> cells;
  std::size_t c = 0;
  for (const auto& entry : problem.mesh.cells)
    for (LocalIndex i = 0; i < entry.size(); ++i, ++c) {
      if (!(clamps[c].limit > 0)) continue;
      const auto& cell = problem.cells[c];
      auto modes = modes_above(element_modes(cell.shape, clamps[c].masses, cell.lame), cell, clamps[c].limit);
      if (!modes.empty()) cells.push_back({cell.nodes, cell.shape.gradients, entry.region, std::move(modes)});
    }
  return cells;
}

StiffnessNow stiffness_now(const Material& material, const Vec3d& stretches) {
  return std::visit(
      [&]<class Model>(const Model& model) -> StiffnessNow {
        if constexpr (HasFibres<Model>) {
          EVERT_ASSERT(false, std::string(Model::name));
        } else {
          if (!(model.lame.mu > 0)) return {};
          const auto bound = kernels::tangent_bound(model, stretches, 1);
          const double growth = bound.stretching + 2 * bound.skew;
          const bool finite = growth < kernels::unresolvable<double>;
          return {finite ? std::max(growth, 1.0) : kernels::unresolvable<double>,
                  finite ? 2 * model.lame.mu * bound.skew : 0};
        }
      },
      material);
}

double stiff_rows(const StiffCell& cell, const Material& material, std::span<const double> x,
                  std::span<TetRow> rows) {
  kernels::Edges<double, 4> edges;
  Mat3d gradient{};
  for (std::size_t a = 1; a < 4; ++a) {
    edges[a - 1] = node_value(x, cell.nodes[a]) - node_value(x, cell.nodes[0]);
    gradient += outer(edges[a - 1], cell.gradients[a]);
  }
  const auto svd = svd3(gradient);
  const Mat3d rotation = times_transpose(svd.u, svd.v);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Mat3d strain = rotation * cell.modes[k].strain;
    kernels::Edges<double, 4> row;
    for (std::size_t a = 1; a < 4; ++a) row[a - 1] = strain * cell.gradients[a];
    filtered::remove_torque<double>(edges, row);
    rows[k] = {-(row[0] + row[1] + row[2]), row[0], row[1], row[2]};
  }
  return stiffness_now(material, svd.sigma).growth;
}

}  // namespace evert
