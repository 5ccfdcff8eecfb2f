#pragma once
#include "evert/bench/kernel_cost.hpp"
#include "evert/bench/sampling.hpp"
#include "evert/core/index.hpp"

#include <mpi.h>

#include <span>
#include <string>
#include <vector>

/// `evert bench kernels`: how fast the kernels are, as rates, against a naive code and against the machine.
namespace evert::bench {

/// The boxes that kernels are measured on, by name.
struct KernelSize {
  std::string name;
  int tet_divisions;  ///< cubes along an edge, of six tetrahedra each
  int hex_divisions;
};
/// "small" (for a quick look), "100K" and "1M".
[[nodiscard]] std::span<const KernelSize> kernel_sizes();

struct KernelRate {
  std::string key;    ///< in JSON
  std::string title;  ///< in the table
  std::string unit;   ///< "Mtet/s"
  Rate rate;          ///< items/s
  KernelCost cost;    ///< of an item; nothing where it is not counted
  // Median rates over others:
  double of_naive = 0;    ///< over that of the naive tetrahedra; 0 where it says nothing
  double of_baij = 0;     ///< over that of PETSc's BAIJ product; 0 where it says nothing
  double of_ceiling = 0;  ///< over what the machine allows; 0 where the cost is not counted
  std::string ceiling;    ///< what the machine has least of: "flops", "divisions" or "bytes"
};

/// What the force of a filtered tetrahedron costs, in those of unfiltered ones of the same model.
struct FilteredCost {
  std::string model;
  double of_unfiltered;
};

struct KernelSizeReport {
  std::string size;
  GlobalIndex tets = 0;
  GlobalIndex hexes = 0;
  double inverted = 0;  ///< share of the tetrahedra
  int rounds = 0;       ///< samples of each
  // Per second, of all ranks:
  Rate flops;      ///< independent multiplications and additions
  Rate divisions;  ///< independent divisions and square roots
  Rate bytes;      ///< of a triad over as much memory as the damped tetrahedra hold
  std::vector<KernelRate> kernels;
  std::vector<FilteredCost> filtered_costs;
};

/// Collective. Measures every kernel at one size for `seconds` each.
[[nodiscard]] KernelSizeReport measure_kernels(MPI_Comm comm, const KernelSize& size, double seconds);

}  // namespace evert::bench
