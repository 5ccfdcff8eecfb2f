#pragma once
#include "evert/core/aligned.hpp"
#include "evert/elements/element_block.hpp"
#include "evert/forces/elastic_block.hpp"
#include "evert/forces/kernels/elastic_kernels.hpp"
#include "evert/forces/plastic_cells.hpp"

#include "rest_stiffness.hpp"
#include <memory>
#include <vector>

namespace evert {

/// The memory of a block, and the calls of ElasticBlock handed on to kernels. Neither copied nor moved: the
/// kernels hold pointers into it.
class BatchedBlock final : public ElasticBlock {
 public:
  BatchedBlock(const ElementView& element, const ElasticCells& cells, std::span<const Vec3d> rest_positions,
               const Material& material, const Damping& damping, const kernels::ElasticKernels& kernels);
  BatchedBlock(const BatchedBlock&) = delete;
  BatchedBlock& operator=(const BatchedBlock&) = delete;

  [[nodiscard]] BatchRange interior() const override { return element_block_.interior; }
  [[nodiscard]] BatchRange boundary() const override { return element_block_.boundary; }
  void update(const double* x, double* f, BatchRange batches) override;
  [[nodiscard]] CellType type() const override { return element_block_.element.type(); }
  [[nodiscard]] const Material& material() const override { return material_; }
  [[nodiscard]] const Damping& damping() const override { return damping_; }
  [[nodiscard]] bool damped() const override { return kernels_.add_damping != nullptr; }
  void add_damping(const double* v, double* out, double factor, BatchRange batches) const override;
  void add_damping_diagonal(double* normal, double* shear, double factor) const override;
  void damping_matrix(LocalIndex cell, std::span<double> matrix) const override;
  void stiffness_matrices(const double* x, TangentForm form, const TakeCellMatrix& take) const override;
  [[nodiscard]] CellNodes cell_nodes(LocalIndex cell) const override;
  [[nodiscard]] LocalIndex cells() const override { return element_block_.cells; }
  [[nodiscard]] double energy(const double* x) const override;
  void min_stretch(const double* x, std::span<double> per_cell) const override;
  [[nodiscard]] LocalIndex inverted_points(const double* x) const override;
  [[nodiscard]] StableStep stable_step(const double* x) const override;
  [[nodiscard]] double max_strain_rate(const double* x, const double* v) const override;
  [[nodiscard]] double rest_stiffness_of(LocalIndex cell) const override;
  void set_mass_shares(std::span<const double> shares) override;
  void set_material(const Material& material, const Damping& damping) override;
  void set_activation(double activation) override { evert::set_activation(material_, activation); }
  [[nodiscard]] PlasticCells* plastic() override { return plastic_.get(); }
  [[nodiscard]] std::size_t memory() const override;

 private:
  void point_kernels_at_memory();
  /// Brings the rest stiffness of what has flown up to date.
  void follow_flow() const;
  [[nodiscard]] Vec3d fibre_at(std::size_t slot, std::size_t q) const;
  [[nodiscard]] BatchRange all() const { return {0, element_block_.batches()}; }

  ElementBlock element_block_;
  Material material_;
  Damping damping_;
  double density_;
  bool mean_dilatation_;
  kernels::ElasticKernels kernels_;
  mutable RestStiffness rest_stiffness_;   // brought up to date when asked for
  std::unique_ptr<PlasticCells> plastic_;  // where something flows
  AlignedVector<float> made_stiffness_;    // λ_e as made, where something flows
  std::vector<double> mass_shares_;        // where something flows
  NumberArray damping_state_;
  kernels::BlockArrays arrays_{};         // into the vectors above
  std::vector<LocalIndex> lane_of_cell_;  // inverse of ElementBlock::cell_of_lane
};

}  // namespace evert
