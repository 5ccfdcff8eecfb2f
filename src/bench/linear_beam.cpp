#include "evert/bench/linear_beam.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/integrators/damping_solver.hpp"
#include "evert/math/nodal.hpp"
#include "evert/mesh/quadratic.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace evert::bench {
namespace {

// (M + s C) v = s f is K u = f up to this part of the softest vibration: M/s against K, ω² of about 10 1/s².
constexpr double scale = 1e10;
constexpr int most_iterations = 40;
// A square section bends two ways at frequencies that only the mesh tells apart: between those the iteration
// turns for long, and which of them it ends at is of no matter.
constexpr double converged = 1e-7;

/// An option of the damping solves for the life of the object, unless the user has set it.
class DefaultOption {
 public:
  DefaultOption(std::string name, const char* value) : name_(std::move(name)) {
    PetscBool given = PETSC_FALSE;
    check(PetscOptionsHasName(nullptr, nullptr, name_.c_str(), &given));
    set_ = given == PETSC_FALSE;
    if (set_) check(PetscOptionsSetValue(nullptr, name_.c_str(), value));
  }
  ~DefaultOption() {
    if (set_) static_cast<void>(PetscOptionsClearValue(nullptr, name_.c_str()));
  }
  DefaultOption(const DefaultOption&) = delete;
  DefaultOption& operator=(const DefaultOption&) = delete;

 private:
  std::string name_;
  bool set_ = false;
};

/// The beam as linear equations: K by the damping operator at rest.
class LinearBeam {
 public:
  LinearBeam(MPI_Comm comm, const Mesh& whole, const Beam& beam)
      : beam_(beam),
        mesh_(distribute(comm, whole)),
        elastic_(mesh_, std::array{ElasticProperties{
                            beam.density, RotatedLinear{.lame = beam.lame()},
                            Damping{DampingModel::rotated, beam.lame().lambda, beam.lame().mu}}}),
        solver_(mesh_, elastic_),
        u_(mesh_) {
    NodeField x(mesh_), f(mesh_);
    for (LocalIndex node = 0; node < mesh_.local_nodes(); ++node)
      set_node_value(x.local(), node, mesh_.rest_positions[static_cast<std::size_t>(node)]);
    x.touched();
    elastic_.update(x, f);
    for (LocalIndex node = 0; node < mesh_.owned_nodes; ++node)
      if (along(node) < 1e-6 * beam.length) hold(node);
    check(VecDuplicate(u_.vec(), right_.out()));
  }

  /// K u = f with the lumped forces `force(i)` of the owned components.
  template <class Force>
  void solve(Force&& force) {
    PetscScalar* values = nullptr;
    check(VecGetArrayWrite(right_.get(), &values));
    for (std::size_t i = 0; i < u_.owned().size(); ++i) values[i] = scale * force(i);
    check(VecRestoreArrayWrite(right_.get(), &values));
    solver_.solve(scale, right_.get(), u_, held_);
  }

  [[nodiscard]] std::span<const double> masses() const { return elastic_.masses(); }
  [[nodiscard]] std::span<const double> solution() const { return u_.owned(); }

  template <std::size_t N>
  void sum(std::array<double, N>& values) const {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), N, MPI_DOUBLE, MPI_SUM, mesh_.comm);
  }

  [[nodiscard]] double tip_deflection() const {
    std::array<double, 2> sums{};
    for (LocalIndex node = 0; node < mesh_.owned_nodes; ++node) {
      if (along(node) < (1 - 1e-6) * beam_.length) continue;
      sums[0] -= node_value(solution(), node)[2];
      sums[1] += 1;
    }
    sum(sums);
    return sums[0] / sums[1];
  }

 private:
  /// The end may not turn, and becomes narrower and wider as the rest does: a clamp that forbids this makes
  /// the beam a percent stiffer than theory, which knows nothing of it.
  void hold(LocalIndex node) {
    const auto& at = mesh_.rest_positions[static_cast<std::size_t>(node)];
    std::array<Vec3d, 3> directions{Vec3d{1, 0, 0}, {}, {}};
    for (std::size_t k = 1; k < 3; ++k)
      if (std::abs(at[k]) < 1e-6 * beam_.height) directions[k][k] = 1;
    held_.push_back({node, projector_off(directions), {}});
  }

  [[nodiscard]] double along(LocalIndex node) const {
    return mesh_.rest_positions[static_cast<std::size_t>(node)][0];
  }

  // A soft beam of stiff elements takes conjugate gradients thousands of iterations. Deflections and
  // frequencies are energies: their error goes with the square of the residual.
  DefaultOption most_iterations_{"-damping_ksp_max_it", "100000"};
  DefaultOption tolerance_{"-damping_ksp_rtol", "1e-6"};
  Beam beam_;
  DistributedMesh mesh_;
  ElasticForces elastic_;
  DampingSolver solver_;
  NodeField u_;
  VecHandle right_;
  std::vector<NodeConstraint> held_;
};

/// The lowest frequency by inverse iteration, from the shape that the weight gives.
double lowest_frequency(LinearBeam& equations) {
  const auto mass = equations.masses();
  double square = 0;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const std::vector<double> before(equations.solution().begin(), equations.solution().end());
    equations.solve([&](std::size_t i) { return mass[i / 3] * before[i]; });
    const auto after = equations.solution();
    std::array<double, 2> products{};  // Rayleigh's quotient: after·K after = after·M before
    for (std::size_t i = 0; i < after.size(); ++i) {
      products[0] += after[i] * mass[i / 3] * before[i];
      products[1] += after[i] * mass[i / 3] * after[i];
    }
    equations.sum(products);
    const double last = square;
    square = products[0] / products[1];
    if (std::abs(square - last) < converged * square) return std::sqrt(square) / (2 * std::numbers::pi);
  }
  throw SimulationError("the lowest frequency of the beam has not converged in " +
                        std::to_string(most_iterations) + " iterations");
}

/// det of the boundary conditions of Timoshenko's free vibrations at angular frequency ω, for a cantilever.
/// W and the rotation ψ are sums of cosh, sinh of a x and cos, sin of b x.
double boundary_determinant(const Beam& beam, double omega) {
  const double area = beam.height * beam.height, inertia = area * beam.height * beam.height / 12;
  const double shear_modulus = beam.lame().mu, nu = beam.poissons_ratio;
  const double kappa = 10 * (1 + nu) / (12 + 11 * nu);
  const double rho = beam.density, ei = beam.youngs_modulus * inertia, kga = kappa * shear_modulus * area;
  // EI W'''' + (ρI + ρA EI/κGA) ω² W'' − (ρA − ρ²AI ω²/κGA) ω² W = 0
  const double w2 = omega * omega;
  const double second = (rho * inertia / ei + rho * area / kga) * w2;
  const double zeroth = (rho * area / ei - rho * area * rho * inertia * w2 / (ei * kga)) * w2;
  const double root = std::sqrt(second * second / 4 + zeroth);
  const double a = std::sqrt(root - second / 2), b = std::sqrt(root + second / 2);
  // κGA (W'' − ψ') = −ρA ω² W
  const double p = (a * a + rho * area * w2 / kga) / a, q = (b * b - rho * area * w2 / kga) / b;
  // W = A cosh + B sinh + C cos + D sin, ψ = p (A sinh + B cosh) + q (−C sin + D cos); W(0) = ψ(0) = 0
  // leaves C = −A and D = −B p/q; at the end ψ' = 0 and W' = ψ.
  const double x = beam.length;
  const double m11 = p * a * std::cosh(a * x) + q * b * std::cos(b * x);
  const double m12 = p * a * std::sinh(a * x) + p * b * std::sin(b * x);
  const double m21 = (a - p) * std::sinh(a * x) + (b - q) * std::sin(b * x);
  const double m22 = (a - p) * std::cosh(a * x) - (b - q) * p / q * std::cos(b * x);
  return m11 * m22 - m12 * m21;
}

}  // namespace

BeamAnswer timoshenko(const Beam& beam) {
  const double area = beam.height * beam.height, inertia = area * beam.height * beam.height / 12;
  const double nu = beam.poissons_ratio, kappa = 10 * (1 + nu) / (12 + 11 * nu);
  const double weight = beam.density * beam.gravity * area, length = beam.length;
  const double bending = weight * std::pow(length, 4) / (8 * beam.youngs_modulus * inertia);
  const double shearing = weight * length * length / (2 * kappa * beam.lame().mu * area);
  // Below Euler's frequency, of which it takes off a little.
  const double euler =
      3.5160152685 / (length * length) * std::sqrt(beam.youngs_modulus * inertia / (beam.density * area));
  double low = 0.5 * euler, high = euler;
  const bool positive = boundary_determinant(beam, low) > 0;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    ((boundary_determinant(beam, middle) > 0) == positive ? low : high) = middle;
  }
  return {bending + shearing, low / (2 * std::numbers::pi)};
}

BeamAnswer solve_beam(MPI_Comm comm, const Mesh& mesh, const Beam& beam, bool with_frequency) {
  LinearBeam equations(comm, mesh, beam);
  const auto mass = equations.masses();
  equations.solve([&](std::size_t i) { return i % 3 == 2 ? -mass[i / 3] * beam.gravity : 0.0; });
  BeamAnswer answer{equations.tip_deflection()};
  if (with_frequency) answer.frequency = lowest_frequency(equations);
  return answer;
}

Mesh beam_mesh(const Beam& beam, BoxCells cells, int across, bool quadratic) {
  const int cubes = quadratic ? across / 2 : across;
  auto mesh = generate_box({beam.length, beam.height, beam.height}, {10 * cubes, cubes, cubes}, cells);
  for (auto& node : mesh.nodes) node[0] += beam.length / 2;
  if (quadratic) make_quadratic(mesh);
  return mesh;
}

}  // namespace evert::bench
