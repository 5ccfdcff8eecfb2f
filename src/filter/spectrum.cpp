#include "evert/filter/spectrum.hpp"

#include "evert/core/error.hpp"

#include <Eigen/Eigenvalues>
#include <slepceps.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace evert {
namespace {

using EpsHandle = PetscHandle<EPS, EPSDestroy>;

/// Starts SLEPc at its first use; PETSc ends it with itself.
void need_slepc() {
  if (SlepcInitializeCalled) return;
  check(SlepcInitializeNoArguments());
  check(PetscRegisterFinalize(SlepcFinalize));
}

/// Values that look random and depend on the node's number alone, so that any number of ranks begin alike.
double start_value(GlobalIndex node, std::uint64_t component) {
  std::uint64_t bits = 3 * static_cast<std::uint64_t>(node) + component + 1;
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;  // splitmix64
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
  bits ^= bits >> 31U;
  return static_cast<double>(bits >> 11U) * 0x1.0p-52 - 1;
}

VecHandle start_vector(const MassScaledStiffness& stiffness) {
  VecHandle start;
  check(MatCreateVecs(stiffness.mat(), start.out(), nullptr));
  PetscScalar* values = nullptr;
  check(VecGetArrayWrite(start.get(), &values));
  const auto& mesh = stiffness.mesh();
  for (LocalIndex i = 0; i < mesh.owned_nodes; ++i)
    for (std::uint64_t k = 0; k < 3; ++k)
      values[3 * static_cast<std::size_t>(i) + k] =
          start_value(mesh.original_nodes[static_cast<std::size_t>(i)], k);
  check(VecRestoreArrayWrite(start.get(), &values));
  check(VecNormalize(start.get(), nullptr));
  return start;
}

EpsHandle krylov_schur(const MassScaledStiffness& stiffness, double tolerance) {
  EpsHandle eps;
  check(EPSCreate(stiffness.mesh().comm, eps.out()));
  check(EPSSetOperators(eps.get(), stiffness.mat(), nullptr));
  check(EPSSetProblemType(eps.get(), EPS_HEP));
  check(EPSSetWhichEigenpairs(eps.get(), EPS_LARGEST_REAL));
  check(EPSSetTolerances(eps.get(), tolerance, 10'000));
  check(EPSSetOptionsPrefix(eps.get(), "stability_"));
  check_options([&] { return EPSSetFromOptions(eps.get()); });
  return eps;
}

}  // namespace

FastestMode fastest_mode(const MassScaledStiffness& stiffness, double tolerance) {
  need_slepc();
  FastestMode mode{0, start_vector(stiffness)};
  const auto eps = krylov_schur(stiffness, tolerance);
  PetscReal norm = 0;
  check(MatNorm(stiffness.mat(), NORM_FROBENIUS, &norm));
  if (norm == 0) return mode;  // every vector is one of 0
  Vec start = mode.scaled.get();
  check(EPSSetInitialSpace(eps.get(), 1, &start));
  check_options([&] { return EPSSolve(eps.get()); });
  PetscInt converged = 0;
  check(EPSGetConverged(eps.get(), &converged));
  if (converged == 0) {
    EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
    check(EPSGetConvergedReason(eps.get(), &reason));
    throw SimulationError("the fastest vibration was not found (" + std::string(EPSConvergedReasons[reason]) +
                          "); a larger -stability_eps_max_it or -stability_eps_ncv may help");
  }
  PetscScalar eigenvalue = 0;
  check(EPSGetEigenpair(eps.get(), 0, &eigenvalue, nullptr, mode.scaled.get(), nullptr));
  mode.squared_frequency = eigenvalue;
  return mode;
}

double lanczos_estimate(const MassScaledStiffness& stiffness, int steps) {
  auto now = start_vector(stiffness);
  VecHandle before, next;
  check(VecDuplicate(now.get(), before.out()));
  check(VecDuplicate(now.get(), next.out()));
  check(VecSet(before.get(), 0));
  std::vector<double> diagonal, below;
  for (int step = 0; step < steps; ++step) {
    check(MatMult(stiffness.mat(), now.get(), next.get()));
    PetscScalar along = 0;
    check(VecDot(next.get(), now.get(), &along));
    diagonal.push_back(along);
    check(VecAXPBYPCZ(next.get(), -along, below.empty() ? 0 : -below.back(), 1, now.get(), before.get()));
    PetscReal length = 0;
    check(VecNormalize(next.get(), &length));
    // The start lies in a space of few vibrations, and all of them are found.
    if (step + 1 == steps || !(length > 1e-12 * std::abs(along))) break;
    below.push_back(length);
    std::swap(before, now);
    std::swap(now, next);
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  const auto size = static_cast<Eigen::Index>(diagonal.size());
  below.resize(diagonal.size() - 1);
  solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(diagonal.data(), size),
                                Eigen::Map<const Eigen::VectorXd>(below.data(), size - 1),
                                Eigen::EigenvaluesOnly);
  return std::max(solver.eigenvalues().maxCoeff(), 0.0);
}

std::vector<FastestMode> modes_above(const MassScaledStiffness& stiffness, double squared_frequency,
                                     int steps) {
  std::vector<VecHandle> basis;
  std::vector<Vec> vectors;
  std::vector<double> diagonal, below, along;
  auto next = start_vector(stiffness);
  for (int step = 0; step < steps; ++step) {
    vectors.push_back(next.get());
    basis.push_back(std::move(next));
    check(VecDuplicate(vectors.back(), next.out()));
    check(MatMult(stiffness.mat(), vectors.back(), next.get()));
    // Against the whole basis and twice: modes that have been found must not come back by rounding.
    const auto size = static_cast<PetscInt>(vectors.size());
    along.resize(vectors.size());
    for (int pass = 0; pass < 2; ++pass) {
      check(VecMDot(next.get(), size, vectors.data(), along.data()));
      if (pass == 0) diagonal.push_back(along.back());
      for (double& share : along) share = -share;
      check(VecMAXPY(next.get(), size, along.data(), vectors.data()));
    }
    PetscReal length = 0;
    check(VecNormalize(next.get(), &length));
    if (step + 1 == steps || !(length > 1e-12 * std::abs(diagonal.front()))) break;
    below.push_back(length);
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  const auto size = static_cast<Eigen::Index>(diagonal.size());
  below.resize(diagonal.size() - 1);
  solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(diagonal.data(), size),
                                Eigen::Map<const Eigen::VectorXd>(below.data(), size - 1));
  std::vector<FastestMode> modes;
  for (Eigen::Index k = size; k-- > 0 && solver.eigenvalues()[k] > squared_frequency;) {
    auto& mode = modes.emplace_back(FastestMode{solver.eigenvalues()[k], {}});
    check(VecDuplicate(vectors.front(), mode.scaled.out()));
    check(VecSet(mode.scaled.get(), 0));
    const Eigen::VectorXd shares = solver.eigenvectors().col(k);
    check(VecMAXPY(mode.scaled.get(), static_cast<PetscInt>(size), shares.data(), vectors.data()));
  }
  return modes;
}

}  // namespace evert
