#pragma once
#include "evert/filter/collatz_wielandt.hpp"
#include "evert/filter/modal_filter.hpp"
#include "evert/filter/spectrum.hpp"

#include "all_bounds.hpp"
#include "tests/support/shared_meshes.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

/// The meshes of PHYSICS 9 with and without a filter.
namespace evert::test {

struct ReferenceMesh {
  const char* name;
  double density;  ///< [kg/m³]
};
inline constexpr std::array<ReferenceMesh, 5> reference_meshes{
    {{"wedge_stack", 0.05}, {"cut_cube", 0.06}, {"ball404", 1000}, {"ball20k", 1000}, {"liver", 1000}}};

/// E 1e4, ν .3 unless said otherwise.
inline ElasticProperties reference_properties(double density, double youngs_modulus = 1e4) {
  return {density, RotatedLinear{.lame = Lame::from_young_poisson(youngs_modulus, 0.3)}, {}};
}

struct FilteredBody {
  const DistributedMesh& mesh;
  ElasticForces elastic;

  FilteredBody(const DistributedMesh& distributed_mesh, double density)
      : mesh(distributed_mesh),
        elastic(mesh, std::vector(mesh.regions.size(), reference_properties(density))) {}

  /// Of M⁻¹K' at rest [1/s²], by SLEPc to 1e-10.
  [[nodiscard]] double largest_eigenvalue() const {
    return fastest_mode(stiffness(), 1e-10).squared_frequency;
  }
  /// Collective. The most that K' does to a rigid motion u, ‖M^−½ K' u‖/‖M^½ u‖ [1/s²].
  [[nodiscard]] double rigid_residual() const {
    const auto matrix = stiffness();
    VecHandle motion, force;
    check(MatCreateVecs(matrix.mat(), motion.out(), force.out()));
    double most = 0;
    for (std::size_t mode = 0; mode < 6; ++mode) {
      Vec3d axis{};
      axis[mode % 3] = 1;
      PetscScalar* values = nullptr;
      check(VecGetArray(motion.get(), &values));
      for (std::size_t i = 0; i < elastic.masses().size(); ++i) {
        const Vec3d u = mode < 3 ? axis : cross(axis, mesh.rest_positions[i]);
        for (std::size_t k = 0; k < 3; ++k) values[3 * i + k] = std::sqrt(elastic.masses()[i]) * u[k];
      }
      check(VecRestoreArray(motion.get(), &values));
      check(MatMult(matrix.mat(), motion.get(), force.get()));
      PetscReal of_force = 0, of_motion = 0;
      check(VecNorm(force.get(), NORM_2, &of_force));
      check(VecNorm(motion.get(), NORM_2, &of_motion));
      most = std::max(most, of_force / of_motion);
    }
    return most;
  }
  [[nodiscard]] double collatz_wielandt() const { return collatz_wielandt_bound(stiffness().mat(), 60); }
  [[nodiscard]] GlobalIndex over_ranks(GlobalIndex count) const {
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, mesh.comm);
    return count;
  }

 private:
  [[nodiscard]] MassScaledStiffness stiffness() const {
    MassScaledStiffness matrix(mesh, elastic);
    auto x = at_rest(mesh);
    matrix.assemble(x);
    return matrix;
  }
};

/// Options whose limit belongs to the step `dt` itself.
inline ModalFilterOptions at_step(double dt, FilterSelection selection) {
  return {.time_step = dt, .safety = 1, .selection = selection};
}

/// The clamps of the rank's cells by their numbers in the undistributed mesh.
inline std::map<GlobalIndex, CellClamp> by_global_number(const DistributedMesh& mesh,
                                                         const CellClamps& clamps) {
  std::map<GlobalIndex, CellClamp> all;
  auto next = clamps.begin();
  for (const auto& entry : mesh.cells)
    for (const GlobalIndex cell : entry.global_ids) all[cell] = *next++;
  return all;
}

/// How far apart, relative to their sizes.
inline double difference(const CellClamp& a, const CellClamp& b) {
  double largest = std::abs(a.limit - b.limit) / std::max({a.limit, b.limit, 1e-300});
  for (std::size_t k = 0; k < 4; ++k)
    largest =
        std::max(largest, std::abs(a.masses[k] - b.masses[k]) / std::max({a.masses[k], b.masses[k], 1e-300}));
  return largest;
}

}  // namespace evert::test
