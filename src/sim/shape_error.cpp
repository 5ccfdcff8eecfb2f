#include "evert/sim/shape_error.hpp"

#include "evert/math/nodal.hpp"
#include "evert/math/svd3.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace evert {

double rms_shape_error(const DistributedMesh& mesh, const NodeField& positions, GlobalIndex first,
                       GlobalIndex end) {
  const auto for_each_node = [&](auto&& visit) {
    for (LocalIndex i = 0; i < mesh.owned_nodes; ++i) {
      const auto node = static_cast<std::size_t>(i);
      if (mesh.original_nodes[node] >= first && mesh.original_nodes[node] < end)
        visit(mesh.rest_positions[node], node_value(positions.owned(), i));
    }
  };
  const auto sum_over_ranks = [&](auto& values) {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM,
                  mesh.comm);
  };

  std::array<double, 7> centers{};  // Σ rest, Σ now, count
  for_each_node([&](const Vec3d& rest, const Vec3d& now) {
    for (std::size_t k = 0; k < 3; ++k) {
      centers[k] += rest[k];
      centers[3 + k] += now[k];
    }
    centers[6] += 1;
  });
  sum_over_ranks(centers);
  const double count = centers[6];
  if (count == 0) return 0;
  const Vec3d rest_center{centers[0] / count, centers[1] / count, centers[2] / count};
  const Vec3d now_center{centers[3] / count, centers[4] / count, centers[5] / count};

  Mat3d covariance{};
  for_each_node([&](const Vec3d& rest, const Vec3d& now) {
    covariance += outer(now - now_center, rest - rest_center);
  });
  std::array<double, 9> entries{};
  for (std::size_t k = 0; k < 9; ++k) entries[k] = covariance.column[k / 3][k % 3];
  sum_over_ranks(entries);
  for (std::size_t k = 0; k < 9; ++k) covariance.column[k / 3][k % 3] = entries[k];
  const auto svd = svd3(covariance);
  const auto rotation = times_transpose(svd.u, svd.v);

  // The distances themselves are summed, not the difference of squares, which would cancel for small errors.
  std::array<double, 1> squares{};
  for_each_node([&](const Vec3d& rest, const Vec3d& now) {
    const auto off = now - now_center - rotation * (rest - rest_center);
    squares[0] += dot(off, off);
  });
  sum_over_ranks(squares);
  return std::sqrt(squares[0] / count);
}

}  // namespace evert
