#include "evert/filter/collatz_wielandt.hpp"

#include "evert/math/eigen_symmetric3.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace evert {
namespace {

// What the norms and their sums may be rounded by is far less.
constexpr double rounding = 1e-12;

double spectral_norm(const Mat3d& block) {
  return std::sqrt(std::max(eigen_symmetric3(transpose_times(block, block)).values[2], 0.0));
}

/// The three rows of one node of the matrix: which nodes they couple it with, and the blocks.
struct NodeRow {
  std::vector<PetscInt> nodes;
  std::vector<Mat3d> blocks;

  void read(Mat a, PetscInt node) {
    nodes.clear();
    blocks.clear();
    for (PetscInt i = 0; i < 3; ++i) {
      PetscInt count = 0;
      const PetscInt* columns = nullptr;
      const PetscScalar* values = nullptr;
      check(MatGetRow(a, 3 * node + i, &count, &columns, &values));
      for (PetscInt k = 0; k < count; ++k) {
        if (i == 0 && k % 3 == 0) {
          nodes.push_back(columns[k] / 3);
          blocks.emplace_back();
        }
        blocks[static_cast<std::size_t>(k / 3)](static_cast<std::size_t>(i),
                                                static_cast<std::size_t>(columns[k] % 3)) = values[k];
      }
      check(MatRestoreRow(a, 3 * node + i, &count, &columns, &values));
    }
  }
};

/// N, one row and column a node.
MatHandle matrix_of_norms(Mat a) {
  MPI_Comm comm = MPI_COMM_NULL;
  check(PetscObjectGetComm(reinterpret_cast<PetscObject>(a), &comm));
  PetscInt begin = 0, end = 0;
  check(MatGetOwnershipRange(a, &begin, &end));
  const PetscInt first = begin / 3, rows = (end - begin) / 3;
  NodeRow row;
  std::vector<PetscInt> own(static_cast<std::size_t>(rows)), others(static_cast<std::size_t>(rows));
  for (PetscInt i = 0; i < rows; ++i) {
    row.read(a, first + i);
    for (const PetscInt node : row.nodes)
      ++(node >= first && node < first + rows ? own : others)[static_cast<std::size_t>(i)];
  }
  MatHandle norms;
  check(MatCreateAIJ(comm, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE, 0, own.data(), 0, others.data(),
                     norms.out()));
  std::vector<PetscScalar> values;
  for (PetscInt i = 0; i < rows; ++i) {
    row.read(a, first + i);
    values.clear();
    for (const Mat3d& block : row.blocks) values.push_back(spectral_norm(block));
    const PetscInt node = first + i;
    check(MatSetValues(norms.get(), 1, &node, static_cast<PetscInt>(row.nodes.size()), row.nodes.data(),
                       values.data(), INSERT_VALUES));
  }
  check(MatAssemblyBegin(norms.get(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(norms.get(), MAT_FINAL_ASSEMBLY));
  return norms;
}

/// Collective. The largest (Nx)_i / x_i; infinity where one is not finite.
double largest_ratio(Vec product, Vec x) {
  double largest = 0;
  PetscInt size = 0;
  const PetscScalar* above = nullptr;
  const PetscScalar* below = nullptr;
  check(VecGetLocalSize(x, &size));
  check(VecGetArrayRead(product, &above));
  check(VecGetArrayRead(x, &below));
  for (PetscInt i = 0; i < size; ++i) {
    const double ratio = above[i] / below[i];
    largest = std::isfinite(ratio) ? std::max(largest, ratio) : std::numeric_limits<double>::infinity();
    if (!std::isfinite(largest)) break;
  }
  check(VecRestoreArrayRead(product, &above));
  check(VecRestoreArrayRead(x, &below));
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX,
                PetscObjectComm(reinterpret_cast<PetscObject>(x)));
  return largest;
}

}  // namespace

CollatzWielandt collatz_wielandt(Mat a, int iterations) {
  // Of x itself, kept so that it stays positive where a row of N has nothing but zeros.
  constexpr double kept = 1e-3;
  const auto norms = matrix_of_norms(a);
  VecHandle x, product;
  check(MatCreateVecs(norms.get(), x.out(), product.out()));
  check(VecSet(x.get(), 1));
  double bound = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < iterations; ++iteration) {
    check(MatMult(norms.get(), x.get(), product.get()));
    bound = std::min(bound, largest_ratio(product.get(), x.get()));
    if (!(bound > 0 && std::isfinite(bound))) break;
    check(VecAXPBY(x.get(), 1 / bound, kept, product.get()));
  }
  return {bound * (1 + rounding), std::move(x)};
}

double collatz_wielandt_bound(Mat a, int iterations) { return collatz_wielandt(a, iterations).bound; }

double step_limit(double squared_frequency) {
  if (!(squared_frequency > 0)) return std::numeric_limits<double>::infinity();
  return 2 / std::sqrt(squared_frequency);
}

}  // namespace evert
