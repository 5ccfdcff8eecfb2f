#pragma once
#include "evert/materials/damping.hpp"
#include "evert/materials/material.hpp"
#include "evert/mesh/mesh.hpp"

/// What the kernels cost at least, to be held against what the machine can do.
namespace evert::bench {

/// Of one item: a tetrahedron, a quadrature point of a hexahedron, a matrix.
struct KernelCost {
  double flops = 0;      ///< additions, subtractions, multiplications, divisions, square roots: one each
  double divisions = 0;  ///< the divisions and square roots among them, which have a slow unit of their own
  double bytes = 0;  ///< that must come from or go to memory when nothing is left in a cache from last time
};

// Found by running the kernels on a scalar that counts (src/bench/counted.hpp): what the sources say, before
// the compiler, which may fuse and reuse. Bytes are those of the cells alone: their node numbers, rest data
// and damping state, a number once, and twice where it is written, because its cache line is read first.
// Those of the nodes, which cells share, are nodal_bytes.

/// ElasticForces::update.
[[nodiscard]] KernelCost force_cost(CellType type, const Material& material,
                                    DampingModel damping = DampingModel::none);
/// The same of neo-Hookean hexahedra on the path of models that need U and V.
[[nodiscard]] KernelCost general_path_cost();
/// ElasticForces::add_damping.
[[nodiscard]] KernelCost damping_cost(CellType type, DampingModel damping);
/// U, σ and V from F in memory; the result stays in a cache.
[[nodiscard]] KernelCost svd_cost();

/// Per node: one field of three doubles is read, another read and written.
inline constexpr double nodal_bytes = 3.0 * 8 * 3;

}  // namespace evert::bench
