#include "evert/filter/mass_scaled_stiffness.hpp"

#include <cmath>

namespace evert {

MassScaledStiffness::MassScaledStiffness(const DistributedMesh& mesh, const ElasticForces& elastic)
    : mesh_(mesh),
      elastic_(elastic),
      matrix_(mesh, elastic, MATBAIJ, [](const ElasticBlock& /*block*/) { return true; }) {
  check(MatCreateVecs(mat(), scale_.out(), nullptr));
  PetscScalar* scale = nullptr;
  check(VecGetArrayWrite(scale_.get(), &scale));
  const auto masses = elastic.masses();
  for (std::size_t i = 0; i < 3 * masses.size(); ++i) scale[i] = 1 / std::sqrt(masses[i / 3]);
  check(VecRestoreArrayWrite(scale_.get(), &scale));
}

void MassScaledStiffness::assemble(NodeField& x) {
  x.touched();
  elastic_.halo().begin_update(x);
  elastic_.halo().end_update(x);
  assemble([&](NodeMatrix& matrix) {
    for (const auto& block : elastic_.blocks()) {
      if (block == nullptr) continue;
      block->stiffness_matrices(x.local().data(), TangentForm::full,
                                [&](LocalIndex cell, std::span<const double> of_cell) {
                                  matrix.add(block->cell_nodes(cell), of_cell);
                                });
    }
  });
}

void MassScaledStiffness::assemble(const std::function<void(NodeMatrix&)>& add_cells) {
  matrix_.begin();
  add_cells(matrix_);
  matrix_.end();
  check(MatDiagonalScale(mat(), scale_.get(), scale_.get()));
}

}  // namespace evert
