#include "evert/integrators/damping_operator.hpp"

#include "evert/math/nodal.hpp"

#include <algorithm>

namespace evert {
namespace {

const DampingOperator& operator_of(Mat mat) {
  const DampingOperator* self = nullptr;
  check(MatShellGetContext(mat, static_cast<void*>(&self)));
  return *self;
}

// Called by PETSc: no exception may pass through its C frames, so failures end here as its error codes.
template <class Work>
PetscErrorCode guarded(Work&& work) {
  try {
    work();
    return 0;
  } catch (const std::exception&) {
    return PETSC_ERR_LIB;
  }
}

PetscErrorCode shell_multiply(Mat mat, Vec x, Vec y) {
  return guarded([&] { operator_of(mat).multiply(x, y); });
}

PetscErrorCode shell_inverse_block_diagonal(Mat mat, const PetscScalar** values) {
  return guarded([&] { *values = operator_of(mat).inverse_diagonal().data(); });
}

PetscErrorCode shell_diagonal(Mat mat, Vec diagonal) {
  return guarded([&] { operator_of(mat).diagonal(diagonal); });
}

std::span<const double> read(Vec vec, std::size_t size) {
  const PetscScalar* values = nullptr;
  check(VecGetArrayRead(vec, &values));
  return {values, size};
}

void done_reading(Vec vec, std::span<const double> values) {
  const PetscScalar* data = values.data();
  check(VecRestoreArrayRead(vec, &data));
}

/// The inverse of a symmetric positive definite 3×3 matrix by columns, by cofactors.
void invert_spd(const double* a, double* inverse) {
  const double c00 = a[4] * a[8] - a[5] * a[7];
  const double c01 = a[5] * a[6] - a[3] * a[8];
  const double c02 = a[3] * a[7] - a[4] * a[6];
  const double scale = 1 / (a[0] * c00 + a[1] * c01 + a[2] * c02);
  inverse[0] = scale * c00;
  inverse[4] = scale * (a[0] * a[8] - a[2] * a[6]);
  inverse[8] = scale * (a[0] * a[4] - a[1] * a[3]);
  inverse[1] = inverse[3] = scale * c01;
  inverse[2] = inverse[6] = scale * c02;
  inverse[5] = inverse[7] = scale * (a[1] * a[6] - a[0] * a[7]);
}

/// B ← P B P for 3×3 matrices by columns.
void project_block(const Mat3d& p, double* b) {
  const Mat3d block{{{{b[0], b[1], b[2]}, {b[3], b[4], b[5]}, {b[6], b[7], b[8]}}}};
  const auto projected = p * block * p;
  for (std::size_t k = 0; k < 9; ++k) b[k] = projected.column[k / 3][k % 3];
}

}  // namespace

DampingOperator::DampingOperator(const DistributedMesh& mesh, const ElasticForces& elastic,
                                 ImplicitStrains* strains)
    : mesh_(mesh),
      elastic_(elastic),
      strains_(strains),
      masses_(elastic.consistent_mass() != nullptr ? elastic.consistent_mass()->diagonal()
                                                   : elastic.masses()),
      in_(mesh),
      out_(mesh),
      normal_(mesh),
      shear_(mesh),
      inverse_diagonal_(9 * static_cast<std::size_t>(mesh.owned_nodes)) {
  if (strains_ != nullptr) of_strains_.emplace(OfStrains{NodeField(mesh), NodeField(mesh), 0});
  const PetscInt rows = 3 * mesh.owned_nodes;
  check(MatCreateShell(mesh.comm, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE, this, mat_.out()));
  check(MatSetBlockSize(mat_.get(), 3));
  check(MatSetOption(mat_.get(), MAT_SPD, PETSC_TRUE));
  const auto set = [&](MatOperation operation, auto function) {
    check(MatShellSetOperation(mat_.get(), operation, reinterpret_cast<void (*)()>(function)));
  };
  set(MATOP_MULT, shell_multiply);
  set(MATOP_MULT_TRANSPOSE, shell_multiply);  // A is symmetric; asked for by bicg, lsqr, ...
  set(MATOP_GET_DIAGONAL, shell_diagonal);
  set(MATOP_INVERT_BLOCK_DIAGONAL, shell_inverse_block_diagonal);
}

void DampingOperator::set(double factor, std::span<const NodeConstraint> constraints) {
  factor_ = factor;
  constraints_ = constraints;
  // Tells PETSc that the preconditioner is out of date.
  check(MatAssemblyBegin(mat_.get(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(mat_.get(), MAT_FINAL_ASSEMBLY));
}

/// y = M x + s P C P x in three passes over the nodes: the mass term of lumped masses goes where C adds to,
/// and P is the identity but at the constrained nodes.
void DampingOperator::multiply(Vec x, Vec y) const {
  auto in = in_.owned();
  auto out = out_.owned();
  const auto values = read(x, in.size());
  const bool lumped = elastic_.consistent_mass() == nullptr;
  for (std::size_t node = 0, i = 0; node < masses_.size(); ++node) {
    const double mass = lumped ? masses_[node] : 0;
    for (const std::size_t end = i + 3; i < end; ++i) {
      in[i] = values[i];
      out[i] = mass * values[i];
    }
  }
  project(constraints_, in);
  in_.touched();
  if (lumped)
    elastic_.add_damping(in_, out_, factor_);
  else
    elastic_.add_momentum_and_damping(in_, out_, factor_);
  if (strains_ != nullptr) strains_->add_product(in_, out_);
  for (const auto& c : constraints_) {
    const auto inertia = masses_[static_cast<std::size_t>(c.node)] * node_value(values, c.node);
    set_node_value(out, c.node, inertia + c.free * (node_value(out, c.node) - inertia));
  }
  PetscScalar* result = nullptr;
  check(VecGetArrayWrite(y, &result));
  std::copy(out.begin(), out.end(), result);
  check(VecRestoreArrayWrite(y, &result));
  done_reading(x, values);
}

template <class Product>
void DampingOperator::add_product(Vec v, Vec out, Product&& product) const {
  auto in = in_.owned();
  auto sum = out_.owned();
  const auto values = read(v, in.size());
  std::copy(values.begin(), values.end(), in.begin());
  done_reading(v, values);
  in_.touched();
  std::fill(sum.begin(), sum.end(), 0.0);
  product();
  PetscScalar* result = nullptr;
  check(VecGetArray(out, &result));
  for (std::size_t i = 0; i < sum.size(); ++i) result[i] += sum[i];
  check(VecRestoreArray(out, &result));
}

void DampingOperator::add_damping(Vec v, Vec out, double factor) const {
  add_product(v, out, [&] { elastic_.add_damping(in_, out_, factor); });
}

void DampingOperator::add_momentum(Vec v, Vec out) const {
  add_product(v, out, [&] { elastic_.add_momentum(in_, out_); });
}

void DampingOperator::add_momentum_and_damping(Vec v, Vec out, double factor) const {
  add_product(v, out, [&] { elastic_.add_momentum_and_damping(in_, out_, factor); });
}

void DampingOperator::update_diagonals() const {
  if (!diagonal_valid_ && elastic_.damped()) elastic_.damping_diagonal(normal_, shear_);
  diagonal_valid_ = true;
  if (strains_ == nullptr || of_strains_->changes == strains_->changes()) return;
  auto& [normal, shear, changes] = *of_strains_;
  std::ranges::fill(normal.local(), 0.0);
  std::ranges::fill(shear.local(), 0.0);
  strains_->add_diagonal(normal, shear);
  changes = strains_->changes();
}

/// work(node, block) for the 3×3 diagonal block of A at each owned node, by columns.
template <class Work>
void DampingOperator::for_each_diagonal_block(Work&& work) const {
  update_diagonals();
  auto constraint = constraints_.begin();
  for (std::size_t node = 0; node < masses_.size(); ++node) {
    const auto at = static_cast<std::ptrdiff_t>(node);
    Vec3d normal = factor_ * node_value(normal_.owned(), at),
          shear = factor_ * node_value(shear_.owned(), at);
    if (of_strains_) {
      normal += node_value(of_strains_->normal.owned(), at);
      shear += node_value(of_strains_->shear.owned(), at);
    }
    const auto [xx, yy, zz] = normal.components;
    const auto [yz, xz, xy] = shear.components;
    std::array<double, 9> block{xx, xy, xz, xy, yy, yz, xz, yz, zz};
    if (constraint != constraints_.end() && static_cast<std::size_t>(constraint->node) == node)
      project_block((constraint++)->free, block.data());
    for (std::size_t k = 0; k < 9; k += 4) block[k] += masses_[node];
    work(node, block);
  }
}

std::span<const double> DampingOperator::inverse_diagonal() const {
  for_each_diagonal_block([&](std::size_t node, const std::array<double, 9>& block) {
    invert_spd(block.data(), &inverse_diagonal_[9 * node]);
  });
  return inverse_diagonal_;
}

void DampingOperator::diagonal(Vec out) const {
  PetscScalar* values = nullptr;
  check(VecGetArrayWrite(out, &values));
  for_each_diagonal_block([&](std::size_t node, const std::array<double, 9>& block) {
    for (std::size_t k = 0; k < 3; ++k) values[3 * node + k] = block[4 * k];
  });
  check(VecRestoreArrayWrite(out, &values));
}

}  // namespace evert
