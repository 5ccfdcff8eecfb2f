#pragma once
#include "evert/elements/element_block.hpp"
#include "evert/materials/damping.hpp"
#include "evert/materials/material.hpp"

#include <cstddef>

/// The kernels of filtered tetrahedra for one instruction set: what crosses the border between code compiled
/// for the baseline and code compiled for a CPU level, as in forces/kernels/elastic_kernels.hpp.
namespace evert::filtered {

/// Where the numbers of a cell stand in its batch, [number][lane].
namespace number {
inline constexpr std::size_t gradients = 0;  ///< ∂N_a/∂X of nodes 1 to 3, x y z each, turned along the filter
inline constexpr std::size_t stretch = 9;  ///< A on the stretches, by columns
inline constexpr std::size_t shear = 18;   ///< A on the shears
inline constexpr std::size_t volume = 21;
inline constexpr std::size_t total = 22;
}  // namespace number

/// What bounds the step of a cell.
namespace bound {
inline constexpr std::size_t inverse_masses = 0;  ///< of the shares of nodes 0 to 3 [1/kg]
inline constexpr std::size_t largest = 4;         ///< eigenvalue of K'_e against them [1/s²]
inline constexpr std::size_t total = 5;
}  // namespace bound

/// The arrays of a block. Padding lanes have the nodes of its last cell; their other numbers are zero.
struct BlockArrays {
  const LocalIndex* nodes;         ///< [batch][node][lane]
  const LocalIndex* cell_of_lane;  ///< [batch][lane]; −1: padding
  const double* cells;             ///< [batch][number::total][lane]
  const double* bounds;            ///< [batch][bound::total][lane]
  double* damping_frames;          ///< [batch][9][lane]: A of damping_kernels.hpp; null without damping
};

/// Named after the calls of ElasticBlock that they serve; `batches` are of `lanes` cells each.
struct Kernels {
  int lanes = 0;
  void (*update)(const BlockArrays&, const Material&, DampingModel, const double* x, double* f, BatchRange);
  void (*add_damping)(const BlockArrays&, const Damping&, double factor, const double* v, double* out,
                      BatchRange);
  void (*add_damping_diagonal)(const BlockArrays&, const Damping&, double factor, double* normal,
                               double* shear, BatchRange);
  double (*energy)(const BlockArrays&, const Material&, const double* x, BatchRange);
  void (*min_stretch)(const BlockArrays&, const double* x, double* per_cell, BatchRange);
  LocalIndex (*inverted_cells)(const BlockArrays&, const double* x, BatchRange);
  /// The largest eigenvalue of any cell at x, at most about [1/s²].
  double (*largest_stiffness)(const BlockArrays&, const Material&, const double* x, BatchRange);
  double (*max_strain_rate)(const BlockArrays&, const double* x, const double* v, BatchRange);
};

/// Those for an isotropic model at the level that kernels::chosen_cpu_level() names.
[[nodiscard]] Kernels kernels_for(const Material& material);

}  // namespace evert::filtered
