#pragma once
#include "evert/forces/elastic_block.hpp"
#include "evert/forces/kernels/cell_batch.hpp"

/// The kernels of one kind of block (element × model × damping) for one instruction set, as plain functions
/// over plain arrays: what crosses the border between code compiled for the baseline and code compiled for a
/// CPU level.
namespace evert {

namespace kernels {

/// Named after the calls of ElasticBlock that they serve.
struct ElasticKernels {
  int lanes = 0;                                     ///< cells per batch that the functions expect
  Precision precision = Precision::full;             ///< of the numbers that they expect
  ShapeData shape_data = ShapeData::node_gradients;  ///< what they expect of the rest shape
  int damping_numbers = 0;                           ///< numbers of damping state per cell
  bool rotated_gradients = false;  ///< the damping state holds h_a, in the form of the shape data, not A
                                   ///< (damping_kernels.hpp)
  bool fibres = false;             ///< they read BlockArrays::fibres
  void (*deform_shapes)(const PlasticArrays&,
                        BatchRange) = nullptr;  ///< null where they know no BlockArrays::plastic
  void (*update)(const BlockArrays&, const Material&, const double* x, double* f, BatchRange) = nullptr;
  void (*add_damping)(const BlockArrays&, const Damping&, double factor, const double* v, double* out,
                      BatchRange) = nullptr;  ///< null without damping, as the next one
  void (*add_damping_diagonal)(const BlockArrays&, const Damping&, double factor, double* normal,
                               double* shear, BatchRange) = nullptr;
  double (*energy)(const BlockArrays&, const Material&, const double* x, BatchRange) = nullptr;
  void (*min_stretch)(const BlockArrays&, const double* x, double* per_cell, BatchRange) = nullptr;
  LocalIndex (*inverted_points)(const BlockArrays&, const double* x, BatchRange) = nullptr;
  StableStep (*stable_step)(const BlockArrays&, const Material&, const Damping&, const double* x,
                            BatchRange) = nullptr;
  double (*max_strain_rate)(const BlockArrays&, const double* x, const double* v, BatchRange) = nullptr;
};

}  // namespace kernels

/// As make_elastic_block of elastic_block.hpp, with given kernels: they must be those of the element, the
/// model and the damping. For elements that Evert does not know (docs/howto/new-element.md), tests and
/// benchmarks.
[[nodiscard]] std::unique_ptr<ElasticBlock> make_elastic_block(
    const ElementView& element, const ElasticCells& cells, std::span<const Vec3d> rest_positions,
    const Material& material, const Damping& damping, const kernels::ElasticKernels& kernels);

/// The same for the reference element of the cells' type.
[[nodiscard]] std::unique_ptr<ElasticBlock> make_elastic_block(const ElasticCells& cells,
                                                               std::span<const Vec3d> rest_positions,
                                                               const Material& material,
                                                               const Damping& damping,
                                                               const kernels::ElasticKernels& kernels);

}  // namespace evert
