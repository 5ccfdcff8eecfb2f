#include "evert/sim/simulation.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/log.hpp"
#include "evert/math/nodal.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace evert {
namespace {

void set_owned(NodeField& field, std::span<const Vec3d> values) {
  for (std::size_t node = 0; node < values.size(); ++node)
    set_node_value(field.owned(), static_cast<std::ptrdiff_t>(node), values[node]);
  field.touched();
}

template <std::size_t N>
void sum_over_ranks(MPI_Comm comm, std::array<double, N>& values) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), N, MPI_DOUBLE, MPI_SUM, comm);
}

const std::array<std::string, 9> impulse_names{
    "gravity_impulse_x",    "gravity_impulse_y",    "gravity_impulse_z",
    "contact_impulse_x",    "contact_impulse_y",    "contact_impulse_z",
    "constraint_impulse_x", "constraint_impulse_y", "constraint_impulse_z"};

std::array<double, 9> as_array(const System::Impulses& impulses) {
  std::array<double, 9> values{};
  for (std::size_t k = 0; k < 3; ++k) {
    values[k] = impulses.gravity[k];
    values[3 + k] = impulses.contact[k];
    values[6 + k] = impulses.constraint[k];
  }
  return values;
}

System::Impulses as_impulses(const std::array<double, 9>& values) {
  return {{values[0], values[1], values[2]},
          {values[3], values[4], values[5]},
          {values[6], values[7], values[8]}};
}

}  // namespace

Simulation::Simulation(DistributedMesh mesh, SimulationDefinition definition)
    : mesh_(std::move(mesh)),
      elastic_(mesh_, definition.properties),
      collisions_(std::move(definition.obstacles), elastic_.masses()),
      prescribed_(std::move(definition.prescribed)),
      system_(mesh_, elastic_, collisions_, prescribed_, definition.gravity),
      integrator_(system_),
      fixed_time_step_(definition.fixed_time_step),
      time_step_(definition.time_step),
      events_(std::move(definition.events)) {
  set_owned(system_.x, definition.initial_positions);
  set_owned(system_.v, definition.initial_velocities);
  forces_stale_ = true;
  apply_due_events();
  refresh_forces();
}

StepReport Simulation::step(double dt) { return step_to(system_.time + dt); }

StepReport Simulation::step_to(double end_time) {
  const double dt = end_time - system_.time;
  apply_due_events();
  refresh_forces();
  const auto report = integrator_.advance(system_, dt);
  system_.time = end_time;
  ++steps_;
  return report;
}

double Simulation::suggested_time_step() {
  apply_due_events();
  refresh_forces();
  return fixed_time_step_ > 0 ? fixed_time_step_ : time_step_.suggest(system_);
}

double Simulation::next_event() const {
  return events_done_ < events_.size() ? events_[events_done_].time : std::numeric_limits<double>::infinity();
}

void Simulation::apply_due_events() {
  while (next_event() <= system_.time) events_[events_done_++].apply(*this);
}

void Simulation::refresh_forces() {
  if (!forces_stale_) return;
  system_.update_forces();
  forces_stale_ = false;
}

void Simulation::min_stretch(std::size_t block, std::span<double> per_cell) const {
  elastic_.min_stretch(system_.x, block, per_cell);
}

GlobalIndex Simulation::inverted_points() const {
  GlobalIndex count = elastic_.inverted_points(system_.x);
  MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, mesh_.comm);
  return count;
}

Measurements Simulation::measure() const {
  const auto mass = elastic_.masses();
  double kinetic = 0;
  double potential = 0;
  Vec3d momentum{};
  Vec3d angular{};
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const auto x = node_value(system_.x.owned(), static_cast<std::ptrdiff_t>(i));
    const auto v = node_value(system_.v.owned(), static_cast<std::ptrdiff_t>(i));
    kinetic += 0.5 * mass[i] * dot(v, v);
    potential -= mass[i] * dot(system_.gravity, x);
    momentum += mass[i] * v;
    angular += mass[i] * cross(x, v);
  }
  std::array<double, 9> sums{kinetic,     elastic_.energy(system_.x),
                             potential,   momentum[0],
                             momentum[1], momentum[2],
                             angular[0],  angular[1],
                             angular[2]};
  sum_over_ranks(mesh_.comm, sums);
  auto impulses = as_array(system_.impulses);
  sum_over_ranks(mesh_.comm, impulses);
  const auto since_restart = as_impulses(impulses);
  Measurements all{sums[0], sums[1], sums[2], {sums[3], sums[4], sums[5]}, {sums[6], sums[7], sums[8]}, {},
                   {},      {},      0};
  all.gravity_impulse = impulses_before_.gravity + since_restart.gravity;
  all.contact_impulse = impulses_before_.contact + since_restart.contact;
  all.constraint_impulse = impulses_before_.constraint + since_restart.constraint;
  all.inverted_points = inverted_points();
  return all;
}

void Simulation::set_properties(std::int32_t region, const ElasticProperties& properties) {
  elastic_.set_properties(region, properties);
  time_step_.reset();
  forces_stale_ = true;
}

void Simulation::set_gravity(const Vec3d& gravity) {
  system_.gravity = gravity;
  forces_stale_ = true;
}

void Simulation::set_friction(const std::string& obstacle, double coefficient) {
  auto* found = collisions_.find(obstacle);
  EVERT_ASSERT(found != nullptr, "obstacle " + obstacle);
  found->set_friction(coefficient);
}

std::vector<StateScalar> Simulation::state_scalars() const {
  const auto control = time_step_.state();
  std::vector<StateScalar> scalars{{"time", system_.time},
                                   {"steps", static_cast<double>(steps_)},
                                   {"events_done", static_cast<double>(events_done_)},
                                   {"stable_time_step", control.stable},
                                   {"stable_time_step_age", control.age}};
  auto impulses = as_array(system_.impulses);
  sum_over_ranks(mesh_.comm, impulses);
  const auto before = as_array(impulses_before_);
  for (std::size_t i = 0; i < impulses.size(); ++i)
    scalars.emplace_back(impulse_names[i], before[i] + impulses[i]);
  return scalars;
}

void Simulation::restore(std::span<const double> positions, std::span<const double> velocities,
                         std::span<const StateScalar> scalars) {
  const auto value = [&](const std::string& name) {
    for (const auto& [key, number] : scalars)
      if (key == name) return number;
    throw UserError("the checkpoint does not hold '" + name +
                    "': it was written by another version of evert");
  };
  // All scalars are looked up before anything is changed.
  const TimeStepControl::State control{value("stable_time_step"), value("stable_time_step_age")};
  std::array<double, 9> impulses{};
  for (std::size_t i = 0; i < impulses.size(); ++i) impulses[i] = value(impulse_names[i]);
  const auto events_done = static_cast<std::size_t>(value("events_done"));
  steps_ = static_cast<std::int64_t>(value("steps"));
  system_.time = value("time");
  std::copy(positions.begin(), positions.end(), system_.x.owned().begin());
  std::copy(velocities.begin(), velocities.end(), system_.v.owned().begin());
  system_.x.touched();
  system_.v.touched();
  impulses_before_ = as_impulses(impulses);
  system_.impulses = {};
  forces_stale_ = true;
  while (events_done_ < std::min(events_done, events_.size())) events_[events_done_++].apply(*this);
  refresh_forces();
  time_step_.restore(control);  // after the events, which reset it
}

}  // namespace evert
