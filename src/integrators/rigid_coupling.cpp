#include "evert/integrators/rigid_coupling.hpp"

#include <array>

namespace evert {
namespace {

constexpr int most_solves = 6;
// Of the impulses. The momentum is exact without; what is left of the velocity is the next step's.
constexpr double tolerance = 1e-3;

/// a + factor b
CentralImpulse sum(const CentralImpulse& a, double factor, const CentralImpulse& b) {
  return {a.linear + factor * b.linear, a.angular + factor * b.angular};
}

}  // namespace

RigidCoupling::RigidCoupling(const System& system) {
  const auto count = system.rigid.bodies().size();
  for (auto* impulse : {&on_bodies_, &residual_, &direction_, &given_, &trial_}) impulse->resize(count);
  before_.resize(count);
  numbers_.resize(6 * count);
}

/// The impulses of the nodes of all ranks.
void RigidCoupling::gather(const System& system, Impulse& sum) {
  const auto bodies = system.rigid.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& [linear, angular] = system.collisions.impulse_of(bodies[b]);
    const auto central = system.rigid.central(bodies[b], linear, angular);
    for (std::size_t k = 0; k < 3; ++k) {
      numbers_[6 * b + k] = central.linear[k];
      numbers_[6 * b + 3 + k] = central.angular[k];
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, numbers_.data(), static_cast<int>(numbers_.size()), MPI_DOUBLE, MPI_SUM,
                system.mesh.comm);
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (std::size_t k = 0; k < 3; ++k) {
      sum[b].linear[k] = numbers_[6 * b + k];
      sum[b].angular[k] = numbers_[6 * b + 3 + k];
    }
}

void RigidCoupling::set(System& system, const Impulse& impulse) {
  const auto bodies = system.rigid.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    before_[b] = system.collisions.obstacles()[bodies[b]]->state();
    system.rigid.set_nodal_impulse(bodies[b], impulse[b]);
  }
}

double RigidCoupling::product(const System& system, const Impulse& a, const Impulse& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += system.rigid.body(system.rigid.bodies()[i]).product(a[i], b[i]);
  return sum;
}

/// Conjugate gradients for s + j(s) = 0 in the scalar product aᵀ M⁻¹ b, in which s → s + j(s) − j(0) is
/// symmetric and positive definite.
void RigidCoupling::solve(System& system, const Follow& follow) {
  const auto count = on_bodies_.size();
  gather(system, given_);
  for (std::size_t b = 0; b < count; ++b) {
    on_bodies_[b] = system.rigid.body(system.rigid.bodies()[b]).nodal_impulse();
    residual_[b] = sum({}, -1, sum(given_[b], 1, on_bodies_[b]));
  }
  direction_ = residual_;
  double square = product(system, residual_, residual_);
  const double enough = tolerance * tolerance * product(system, given_, given_);
  int solves = 0;
  while (square > enough && solves < most_solves) {
    for (std::size_t b = 0; b < count; ++b) trial_[b] = sum(on_bodies_[b], 1, direction_[b]);
    set(system, trial_);
    follow(before_);
    ++solves;
    gather(system, trial_);  // j(s + d); j(s) stands in given_
    for (std::size_t b = 0; b < count; ++b) trial_[b] = sum(direction_[b], 1, sum(trial_[b], -1, given_[b]));
    const double step = square / product(system, direction_, trial_);
    for (std::size_t b = 0; b < count; ++b) {
      on_bodies_[b] = sum(on_bodies_[b], step, direction_[b]);
      residual_[b] = sum(residual_[b], -step, trial_[b]);
      given_[b] = sum({}, -1, sum(residual_[b], 1, on_bodies_[b]));
    }
    const double before = square;
    square = product(system, residual_, residual_);
    for (std::size_t b = 0; b < count; ++b) direction_[b] = sum(residual_[b], square / before, direction_[b]);
  }
  if (solves == 0) return;
  set(system, on_bodies_);
  follow(before_);
}

void RigidCoupling::finish(System& system) {
  gather(system, given_);
  for (auto& impulse : given_) impulse = sum({}, -1, impulse);
  set(system, given_);
}

}  // namespace evert
