#include "evert/sim/simulation.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/log.hpp"
#include "evert/math/nodal.hpp"

#include "diagnosis.hpp"
#include "flow_goals.hpp"
#include "motion.hpp"
#include "requirements.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <type_traits>

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

const std::array<std::string, 12> impulse_names{
    "gravity_impulse_x",    "gravity_impulse_y", "gravity_impulse_z",    "contact_impulse_x",
    "contact_impulse_y",    "contact_impulse_z", "constraint_impulse_x", "constraint_impulse_y",
    "constraint_impulse_z", "damping_impulse_x", "damping_impulse_y",    "damping_impulse_z"};

std::array<double, 12> as_array(const System::Impulses& impulses) {
  std::array<double, 12> values{};
  for (std::size_t k = 0; k < 3; ++k) {
    values[k] = impulses.gravity[k];
    values[3 + k] = impulses.contact[k];
    values[6 + k] = impulses.constraint[k];
    values[9 + k] = impulses.damping[k];
  }
  return values;
}

System::Impulses as_impulses(const std::array<double, 12>& values) {
  return {{values[0], values[1], values[2]},
          {values[3], values[4], values[5]},
          {values[6], values[7], values[8]},
          {values[9], values[10], values[11]}};
}

/// Collective. No rank has anything that changes on the way, holds, or pulls, but gravity and obstacles.
bool is_closed(MPI_Comm comm, const SimulationDefinition& definition, bool held, bool loaded) {
  int closed = !held && !loaded && definition.activations.empty() && definition.goals.empty() &&
                       definition.events.empty()
                   ? 1
                   : 0;
  MPI_Allreduce(MPI_IN_PLACE, &closed, 1, MPI_INT, MPI_MIN, comm);
  return closed != 0;
}

/// Collective. None where the definition has none.
std::unique_ptr<ModalFilter> make_filter(const SimulationDefinition& definition, const DistributedMesh& mesh,
                                         ElasticForces& elastic) {
  if (!definition.filter) return nullptr;
  auto options = *definition.filter;
  options.implicit_damping = definition.method == IntegrationMethod::newmark;
  options.integrator_safety = definition.time_step.safety;
  options.fixed_time_step = definition.fixed_time_step;
  options.stability_constant = stability_constant_of(definition.method);
  if (!(options.stability_constant > 0))
    throw UserError("filter: no filter makes explicit_euler stable; it goes with newmark");
  if (std::isinf(options.stability_constant))
    throw UserError("filter: has no effect on states of rest, which no step is too large for");
  return std::make_unique<ModalFilter>(mesh, elastic, options);
}

/// Collective. Of a compliant filter.
std::unique_ptr<ImplicitStrains> make_implicit_strains(const DistributedMesh& mesh,
                                                       const ElasticForces& elastic,
                                                       const ModalFilter* filter) {
  if (filter == nullptr || filter->options().constraints != FilterConstraints::compliant) return nullptr;
  return std::make_unique<ImplicitStrains>(mesh, elastic, *filter);
}

std::string impulse_name(const Obstacle& obstacle, const char* what, std::size_t axis) {
  return "obstacles." + obstacle.name() + "." + what + "_" + "xyz"[axis];
}

/// Collective. Of a filter with `paper` constraints.
std::unique_ptr<ShapeProjection> make_projection(const DistributedMesh& mesh, const ElasticForces& elastic,
                                                 const ModalFilter* filter) {
  if (filter == nullptr || filter->options().constraints != FilterConstraints::paper) return nullptr;
  return std::make_unique<ShapeProjection>(mesh, elastic, *filter);
}

}  // namespace

Simulation::Simulation(DistributedMesh mesh, SimulationDefinition definition)
    : mesh_(std::move(mesh)),
      elastic_(mesh_, definition.properties, possible_mass(definition)),
      filter_(make_filter(definition, mesh_, elastic_)),
      implicit_strains_(make_implicit_strains(mesh_, elastic_, filter_.get())),
      projection_(make_projection(mesh_, elastic_, filter_.get())),
      collisions_(possible_obstacles(definition), elastic_.masses()),
      rigid_(collisions_.obstacles()),
      prescribed_(std::move(definition.prescribed)),
      system_(mesh_, elastic_, collisions_, rigid_, prescribed_, definition.gravity,
              std::move(definition.body_force), implicit_strains_.get()),
      integrator_(make_integrator(definition.method, system_, definition.quasistatic)),
      fixed_time_step_(definition.fixed_time_step),
      time_step_(definition.time_step),
      soundness_(mesh_, is_closed(mesh_.comm, definition, !prescribed_.empty(),
                                  static_cast<bool>(system_.body_force))),
      activations_(std::move(definition.activations)),
      events_(std::move(definition.events)),
      obstacle_impulses_before_(system_.obstacle_impulses.size()) {
  for (const auto& goal : definition.goals) set_goal(elastic_, mesh_, goal);
  system_.projection = projection_.get();
  set_owned(system_.x, definition.initial_positions);
  set_owned(system_.v, definition.initial_velocities);
  forces_stale_ = true;
  apply_due_events();
  refresh_forces();
  agree_on_state(0);
}

StepReport Simulation::step(double dt) { return step_to(system_.time + dt); }

StepReport Simulation::step_to(double end_time) {
  const double dt = end_time - system_.time;
  if (!(dt > 0)) give_up("the time step is lost in the rounding of the time");
  apply_due_events();
  follow_flow();
  refresh_forces();
  activate(end_time);  // forces are computed next at the end of the step
  auto report = advance(dt);
  system_.time = end_time;
  ++steps_;
  report.stop_requested = agree_on_state(dt);
  return report;
}

StepReport Simulation::advance(double dt) {
  try {
    return std::visit([&](auto& integrator) { return integrator.advance(system_, dt); }, integrator_);
  } catch (const SimulationError& error) {  // of a solve, on all ranks; it knows no time
    const auto what = moment() + error.what();
    throw SimulationError(
        what + blame_of_step(system_, integrator_, filter_.get(), {.dt = dt, .fixed = fixed_time_step_ > 0}));
  }
}

bool Simulation::agree_on_state(double dt) {
  const auto found = soundness_.look(system_, dt, stop_requested_);
  if (found.ailment != Ailment::none) {
    const auto what = moment() + what_happened(system_, found, soundness_);
    throw SimulationError(
        what + what_to_try(system_, integrator_, filter_.get(), {.dt = dt, .fixed = fixed_time_step_ > 0}));
  }
  return found.stop;
}

std::string Simulation::moment() const {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "at t = %.6g s, step %lld: ", system_.time,
                static_cast<long long>(steps_));
  return text.data();
}

void Simulation::give_up(const std::string& what) const {
  std::array<char, 96> advice{};
  if (steps_ == 0)
    std::snprintf(advice.data(), advice.size(), "; look at the numbers of the scene");
  else if (fixed_time_step_ > 0)
    std::snprintf(advice.data(), advice.size(), "; an integrator.time_step below %.6g s, or auto, may help",
                  fixed_time_step_);
  else
    std::snprintf(advice.data(), advice.size(),
                  "; a smaller integrator.safety or max_strain_increment may help");
  throw SimulationError(moment() + what + advice.data());
}

double Simulation::suggested_time_step() {
  apply_due_events();
  refresh_forces();
  if (fixed_time_step_ > 0) return fixed_time_step_;
  if (quasistatic()) return std::numeric_limits<double>::infinity();
  const auto limit = std::visit(
      [](const auto& integrator) -> StabilityLimit {
        return &std::remove_cvref_t<decltype(integrator)>::stable_step;
      },
      integrator_);
  double dt = time_step_.suggest(system_, limit);
  if (filter_) dt = std::min(dt, filter_->time_step());
  if (!time_step_.is_fresh() || !activation_rises(time_step_.horizon())) return dt;
  // The bound must hold until it is asked again: once more, as stiff as muscle will be by then.
  activate_highest(system_.time + time_step_.horizon());
  time_step_.reset();
  const double ahead = time_step_.suggest(system_, limit);
  activate(system_.time);
  return std::min(dt, ahead);
}

double Simulation::next_event() const {
  double next = std::numeric_limits<double>::infinity();
  if (events_done_ < events_.size()) next = events_[events_done_].time;
  for (const auto& activation : activations_) next = std::min(next, activation.next_keyframe(system_.time));
  return next;
}

void Simulation::apply_due_events() {
  while (events_done_ < events_.size() && events_[events_done_].time <= system_.time)
    events_[events_done_++].apply(*this);
}

void Simulation::follow_flow() {
  if (!filter_ || !filter_->follow_flow()) return;
  time_step_.reset();
  forces_stale_ = true;
}

void Simulation::refresh_forces() {
  if (!forces_stale_) return;
  activate(system_.time);
  system_.update_forces(system_.time);
  forces_stale_ = false;
}

void Simulation::activate(double time) {
  for (const auto& activation : activations_) elastic_.set_activation(activation.region, activation.at(time));
}

void Simulation::activate_highest(double until) {
  for (const auto& activation : activations_)
    elastic_.set_activation(activation.region,
                            activation.at(system_.time) + activation.rise(system_.time, until));
}

bool Simulation::activation_rises(double duration) const {
  constexpr double much = 0.01;  // of a full activation: far below what the safety of the step leaves
  for (const auto& activation : activations_)
    if (activation.rise(system_.time, system_.time + duration) > much) return true;
  return false;
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
  auto [kinetic, momentum, angular] = motion_of(system_);
  const auto mass = elastic_.mass_row_sums();
  double potential = 0;
  for (std::size_t i = 0; i < mass.size(); ++i)
    potential -=
        mass[i] * dot(system_.gravity, node_value(system_.x.owned(), static_cast<std::ptrdiff_t>(i)));
  if (rank_of(mesh_.comm) == 0) {  // every rank has all rigid bodies
    for (const auto number : rigid_.bodies()) {
      const auto& body = rigid_.body(number);
      const auto of_body = body.mass().mass * body.velocity();
      kinetic += body.kinetic_energy();
      potential -= body.mass().mass * dot(system_.gravity, body.center());
      momentum += of_body;
      angular += cross(body.center(), of_body) + body.angular_momentum();
    }
  }
  const auto plastic = elastic_.plastic_state();
  std::array<double, 13> sums{kinetic,
                              elastic_.energy(system_.x),
                              potential,
                              momentum[0],
                              momentum[1],
                              momentum[2],
                              angular[0],
                              angular[1],
                              angular[2],
                              plastic.work,
                              plastic.control_work,
                              plastic.goal_square,
                              plastic.goal_distance_square};
  sum_over_ranks(mesh_.comm, sums);
  auto impulses = as_array(system_.impulses);
  sum_over_ranks(mesh_.comm, impulses);
  const auto since_restart = as_impulses(impulses);
  Measurements all{.kinetic_energy = sums[0],
                   .elastic_energy = sums[1],
                   .gravitational_energy = sums[2],
                   .momentum = {sums[3], sums[4], sums[5]},
                   .angular_momentum = {sums[6], sums[7], sums[8]}};
  all.plastic_work = sums[9];
  all.control_work = sums[10];
  if (sums[11] > 0) all.goal_distance = std::sqrt(sums[12] / sums[11]);
  all.gravity_impulse = impulses_before_.gravity + since_restart.gravity;
  all.contact_impulse = impulses_before_.contact + since_restart.contact;
  all.constraint_impulse = impulses_before_.constraint + since_restart.constraint;
  all.damping_impulse = impulses_before_.damping + since_restart.damping;
  all.inverted_points = inverted_points();
  return all;
}

std::vector<ObstacleImpulse> Simulation::obstacle_impulses() const {
  const auto& mine = system_.obstacle_impulses;
  std::vector<double> numbers;
  for (const auto& [linear, angular] : mine)
    for (const auto* vector : {&linear, &angular})
      numbers.insert(numbers.end(), vector->components.begin(), vector->components.end());
  MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_DOUBLE, MPI_SUM,
                mesh_.comm);
  auto all = obstacle_impulses_before_;
  for (std::size_t o = 0; o < all.size(); ++o)
    for (std::size_t k = 0; k < 3; ++k) {
      all[o].linear[k] += numbers[6 * o + k];
      all[o].angular[k] += numbers[6 * o + 3 + k];
    }
  return all;
}

void Simulation::set_properties(std::int32_t region, const ElasticProperties& properties) {
  elastic_.set_properties(region, properties);
  if (filter_) filter_->material_changed(region);
  time_step_.reset();
  soundness_.forget();
  forces_stale_ = true;
}

void Simulation::set_gravity(const Vec3d& gravity) {
  system_.gravity = gravity;
  soundness_.forget();
  forces_stale_ = true;
}

void Simulation::set_friction(const std::string& obstacle, double coefficient) {
  auto* found = collisions_.find(obstacle);
  EVERT_ASSERT(found != nullptr, "obstacle " + obstacle);
  found->set_friction(coefficient);
}

NodeState Simulation::node_state() const {
  return {system_.x.owned(), system_.v.owned(), system_.v_change.owned()};
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
  const auto given = obstacle_impulses();
  for (std::size_t o = 0; o < given.size(); ++o)
    for (std::size_t k = 0; k < 3; ++k) {
      scalars.emplace_back(impulse_name(*obstacles()[o], "impulse", k), given[o].linear[k]);
      scalars.emplace_back(impulse_name(*obstacles()[o], "angular_impulse", k), given[o].angular[k]);
    }
  const auto bodies = rigid_.state();
  scalars.insert(scalars.end(), bodies.begin(), bodies.end());
  return scalars;
}

FlowState Simulation::flow_state() const {
  FlowState state;
  for (std::size_t e = 0; e < mesh_.cells.size(); ++e) state.push_back(elastic_.flow(e));
  return state;
}

void Simulation::restore(const NodeState& nodes, std::span<const StateScalar> scalars,
                         const FlowState& flow) {
  const auto value = [&](const std::string& name) {
    for (const auto& [key, number] : scalars)
      if (key == name) return number;
    throw UserError("the checkpoint does not hold '" + name +
                    "': it was written by another version of evert");
  };
  // All scalars are looked up before anything is changed.
  const TimeStepControl::State control{value("stable_time_step"), value("stable_time_step_age")};
  std::array<double, 12> impulses{};
  for (std::size_t i = 0; i < impulses.size(); ++i) impulses[i] = value(impulse_names[i]);
  auto given = obstacle_impulses_before_;
  for (std::size_t o = 0; o < given.size(); ++o)
    for (std::size_t k = 0; k < 3; ++k) {
      given[o].linear[k] = value(impulse_name(*obstacles()[o], "impulse", k));
      given[o].angular[k] = value(impulse_name(*obstacles()[o], "angular_impulse", k));
    }
  const auto events_done = static_cast<std::size_t>(value("events_done"));
  const auto steps = static_cast<std::int64_t>(value("steps"));
  const double time = value("time");
  auto bodies = rigid_.state();
  for (auto& [name, number] : bodies) number = value(name);

  steps_ = steps;
  system_.time = time;
  system_.forces_time = time;
  const auto replace = [](NodeField& field, std::span<const double> values) {
    std::copy(values.begin(), values.end(), field.owned().begin());
    field.touched();
  };
  replace(system_.x, nodes.positions);
  replace(system_.v, nodes.velocities);
  replace(system_.v_change, nodes.velocity_changes);
  impulses_before_ = as_impulses(impulses);
  system_.impulses = {};
  obstacle_impulses_before_ = std::move(given);
  std::fill(system_.obstacle_impulses.begin(), system_.obstacle_impulses.end(), ObstacleImpulse{});
  for (const auto& obstacle : obstacles()) obstacle->move_to({.end = system_.time, .dt = 1});
  rigid_.restore(bodies, time);
  forces_stale_ = true;
  while (events_done_ < std::min(events_done, events_.size())) events_[events_done_++].apply(*this);
  for (std::size_t e = 0; e < flow.size(); ++e) elastic_.set_flow(e, flow[e]);
  follow_flow();
  refresh_forces();
  time_step_.restore(control);  // after the events, which reset it
  soundness_.forget();
  agree_on_state(0);
}

}  // namespace evert
