#pragma once
#include "evert/bench/kernel_cost.hpp"
#include "evert/bench/naive_forces.hpp"
#include "evert/bench/sampling.hpp"
#include "evert/bench/specimen.hpp"
#include "evert/core/aligned.hpp"
#include "evert/forces/elastic_forces.hpp"
#include "evert/integrators/damping_matrix.hpp"
#include "evert/math/svd3_batch.hpp"
#include "evert/mesh/partition.hpp"

#include <array>
#include <memory>
#include <vector>

namespace evert::bench {

/// Goes through a list in so many parts, one at a time and over again: a sample of a slow loop over a large
/// mesh is then as short as the others.
class Parts {
 public:
  Parts(std::size_t size, std::size_t parts) : size_(size), parts_(parts) {}

  struct Range {
    std::size_t begin, end;
  };
  Range next() {
    const Range range{size_ * part_ / parts_, size_ * (part_ + 1) / parts_};
    part_ = (part_ + 1) % parts_;
    return range;
  }
  [[nodiscard]] std::size_t count() const { return parts_; }

 private:
  std::size_t size_;
  std::size_t parts_;
  std::size_t part_ = 0;
};

/// A material in the place of that of a specimen.
struct MaterialForces {
  Material material;
  ElasticForces elastic;
};
/// That of specimens.
[[nodiscard]] Material bench_material();
/// Whatever else there is, each by default; muscle at half activation.
[[nodiscard]] std::vector<Material> other_materials();
[[nodiscard]] std::vector<Material> materials_with_fibres();

/// The tetrahedra of a specimen as the modal filter leaves them, all of them.
struct FilteredForces {
  Material material;
  std::unique_ptr<ElasticBlock> block;
};

/// The tetrahedra of a specimen with plasticity.
struct PlasticForces {
  std::unique_ptr<ElasticBlock> block;
  /// Local positions that it is brought to by turns, as NodeField::local.
  std::array<AlignedVector<double>, 2> positions;
  std::size_t turn = 0;
};

/// A box of tetrahedra and all that is done to it.
class TetSubject {
 public:
  /// Collective.
  TetSubject(MPI_Comm comm, int divisions);

  [[nodiscard]] double cells() const { return static_cast<double>(specimen_.mesh.total_cells); }
  [[nodiscard]] double nodes_per_cell() const {
    return static_cast<double>(specimen_.mesh.total_nodes) / cells();
  }
  /// Collective. Share of the cells.
  [[nodiscard]] double inverted() const;
  /// Bytes of element data of the damped cells on this rank.
  [[nodiscard]] std::size_t memory() const { return damped_.memory(); }
  /// Collective. Of one product with the assembled matrix, per tetrahedron.
  [[nodiscard]] KernelCost baij_cost() const;

  // Collective; each does what its name says once, or to one part of the cells.
  void force() { plain_.update(specimen_.positions, result_); }
  void damped_force() { damped_.update(specimen_.positions, result_); }
  [[nodiscard]] const auto& others() const { return others_; }
  void force(MaterialForces& of) { of.elastic.update(specimen_.positions, result_); }
  /// Filtered, of every model that can be; halo left out.
  [[nodiscard]] const auto& filtered() const { return filtered_; }
  void force(const FilteredForces& of);
  /// With a yield that is not reached, and, between two shapes in turn, with all of them flowing; halo left
  /// out.
  void elastic_force_of_plastic() { force(not_yielding_); }
  void flowing_force() { force(flowing_); }
  void damping();
  void matrix_free_product() { check(MatMult(operator_.mat(), specimen_.velocities.vec(), result_.vec())); }
  void baij_product() { check(MatMult(assembled_.mat(), specimen_.velocities.vec(), result_.vec())); }
  void naive_force_part();
  void svd_part();
  /// Tetrahedra, of all ranks, in a part.
  [[nodiscard]] double cells_per_part() const { return cells() / static_cast<double>(naive_parts_.count()); }

 private:
  void force(PlasticForces& of);

  Specimen specimen_;
  NodeField result_;
  ElasticForces plain_;
  ElasticForces damped_;
  std::vector<std::unique_ptr<MaterialForces>> others_;
  std::vector<FilteredForces> filtered_;
  PlasticForces not_yielding_, flowing_;
  DampingOperator operator_;
  AssembledDamping assembled_;
  NaiveForces naive_;
  std::vector<double> naive_result_;
  Parts naive_parts_;
  std::vector<Mat3d> gradients_;  // F of every cell
  Parts svd_parts_;
  std::vector<Svd3<double>> decompositions_;
};

/// A box of cells of one type.
class ElementSubject {
 public:
  /// Collective.
  ElementSubject(MPI_Comm comm, CellType type, int divisions);

  [[nodiscard]] double cells() const { return static_cast<double>(specimen_.mesh.total_cells); }
  [[nodiscard]] double points() const { return cells() * quadrature_points(type_); }
  [[nodiscard]] double nodes_per_point() const {
    return static_cast<double>(specimen_.mesh.total_nodes) / points();
  }
  void force() { plain_.update(specimen_.positions, result_); }

 protected:
  CellType type_;
  Specimen specimen_;
  NodeField result_;
  ElasticForces plain_;
};

/// A box of hexahedra, which also go the way of models that need U and V.
class HexSubject : public ElementSubject {
 public:
  /// Collective.
  HexSubject(MPI_Comm comm, int divisions);

  /// By U and V, without sum factorisation; halo left out.
  void general_force();
  [[nodiscard]] const auto& others() const { return others_; }
  void force(MaterialForces& of) { of.elastic.update(specimen_.positions, result_); }

 private:
  std::unique_ptr<ElasticBlock> general_;
  std::vector<std::unique_ptr<MaterialForces>> others_;
};

/// What the machine can do.
class CeilingSubject {
 public:
  /// Triads over `memory` bytes in all.
  explicit CeilingSubject(std::size_t memory);

  // Of one call:
  [[nodiscard]] static double flops();
  [[nodiscard]] static double divisions();
  [[nodiscard]] double triad_bytes() const;

  void multiply_add();
  void divide_and_root();
  void triad();

 private:
  AlignedVector<double> a_, b_, c_;
  double sum_ = 0;  // keeps the loops alive
};

}  // namespace evert::bench
