#include "evert/io/csv_log.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/io/files.hpp"

#include "number_text.hpp"
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <string_view>

namespace evert {
namespace {

struct Column {
  std::string_view name;
  double (*value)(const Measurements& m);
};

// clang-format off
constexpr std::array columns{
    Column{"kinetic_energy [J]", [](const Measurements& m) { return m.kinetic_energy; }},
    Column{"elastic_energy [J]", [](const Measurements& m) { return m.elastic_energy; }},
    Column{"gravitational_energy [J]", [](const Measurements& m) { return m.gravitational_energy; }},
    Column{"total_energy [J]", [](const Measurements& m) { return m.total_energy(); }},
    Column{"momentum_x [N s]", [](const Measurements& m) { return m.momentum[0]; }},
    Column{"momentum_y [N s]", [](const Measurements& m) { return m.momentum[1]; }},
    Column{"momentum_z [N s]", [](const Measurements& m) { return m.momentum[2]; }},
    Column{"angular_momentum_x [N m s]", [](const Measurements& m) { return m.angular_momentum[0]; }},
    Column{"angular_momentum_y [N m s]", [](const Measurements& m) { return m.angular_momentum[1]; }},
    Column{"angular_momentum_z [N m s]", [](const Measurements& m) { return m.angular_momentum[2]; }},
    Column{"gravity_impulse_x [N s]", [](const Measurements& m) { return m.gravity_impulse[0]; }},
    Column{"gravity_impulse_y [N s]", [](const Measurements& m) { return m.gravity_impulse[1]; }},
    Column{"gravity_impulse_z [N s]", [](const Measurements& m) { return m.gravity_impulse[2]; }},
    Column{"contact_impulse_x [N s]", [](const Measurements& m) { return m.contact_impulse[0]; }},
    Column{"contact_impulse_y [N s]", [](const Measurements& m) { return m.contact_impulse[1]; }},
    Column{"contact_impulse_z [N s]", [](const Measurements& m) { return m.contact_impulse[2]; }},
    Column{"constraint_impulse_x [N s]", [](const Measurements& m) { return m.constraint_impulse[0]; }},
    Column{"constraint_impulse_y [N s]", [](const Measurements& m) { return m.constraint_impulse[1]; }},
    Column{"constraint_impulse_z [N s]", [](const Measurements& m) { return m.constraint_impulse[2]; }},
    Column{"damping_impulse_x [N s]", [](const Measurements& m) { return m.damping_impulse[0]; }},
    Column{"damping_impulse_y [N s]", [](const Measurements& m) { return m.damping_impulse[1]; }},
    Column{"damping_impulse_z [N s]", [](const Measurements& m) { return m.damping_impulse[2]; }},
    Column{"inverted_points", [](const Measurements& m) { return static_cast<double>(m.inverted_points); }},
};
constexpr std::array flow_columns{
    Column{"plastic_work [J]", [](const Measurements& m) { return m.plastic_work; }},
    Column{"control_work [J]", [](const Measurements& m) { return m.control_work; }},
    Column{"goal_distance [-]", [](const Measurements& m) { return m.goal_distance; }},
};
// clang-format on

std::string header(const std::vector<std::string>& names) {
  std::string text = "time [s],step";
  for (const auto& name : names) (text += ',') += name;
  return text + '\n';
}

std::vector<Column> energy_columns(bool with_flow) {
  std::vector<Column> all(columns.begin(), columns.end());
  if (with_flow) all.insert(all.end(), flow_columns.begin(), flow_columns.end());
  return all;
}

std::vector<std::string> energy_names(bool with_flow) {
  std::vector<std::string> names;
  for (const auto& column : energy_columns(with_flow)) names.emplace_back(column.name);
  return names;
}

struct Quantity {
  std::string_view name, unit;
};
// clang-format off
constexpr std::array quantities{
    Quantity{"impulse", "N s"}, Quantity{"angular_impulse", "N m s"}, Quantity{"force", "N"},
    Quantity{"position", "m"}, Quantity{"velocity", "m/s"}, Quantity{"angular_velocity", "rad/s"},
};
// clang-format on

std::vector<std::string> obstacle_columns(std::span<const std::unique_ptr<Obstacle>> obstacles) {
  std::vector<std::string> names;
  for (const auto& obstacle : obstacles)
    for (const auto& [name, unit] : quantities)
      for (const char axis : {'x', 'y', 'z'})
        names.push_back(obstacle->name() + '.' + std::string(name) + '_' + axis + " [" + std::string(unit) +
                        ']');
  return names;
}

/// The first value of a row.
double time_of(std::string_view row) {
  double time = 0;
  std::from_chars(row.data(), row.data() + row.size(), time);
  return time;
}

/// `header` and rows up to `time` of the log at `path`; a last row cut by a kill is left out.
std::string rows_until(const std::string& path, const std::string& header, double time) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return header;
  std::string line;
  if (!std::getline(file, line) || line + '\n' != header)
    throw UserError("cannot continue '" + path + "': it is not a log with the columns of this evert");
  std::string kept = header;
  while (std::getline(file, line) && !file.eof() && time_of(line) <= time) (kept += line) += '\n';
  return kept;
}

}  // namespace

CsvLog::CsvLog(MPI_Comm comm, const std::string& path, const std::vector<std::string>& names)
    : CsvLog(comm, path, header(names)) {}

CsvLog::CsvLog(MPI_Comm comm, const std::string& path, const std::string& begin) : comm_(comm), path_(path) {
  on_root(comm_, [&] {
    require_writable(path_);
    file_.reset(std::fopen(path_.c_str(), "wb"));
    if (!file_) throw UserError("cannot write '" + path_ + "': " + std::strerror(errno));
    append(begin);
  });
}

CsvLog CsvLog::continue_from(MPI_Comm comm, const std::string& path, const std::vector<std::string>& names,
                             double time) {
  std::string begin;
  on_root(comm, [&] { begin = rows_until(path, header(names), time); });
  return {comm, path, begin};
}

void CsvLog::append(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0)
    throw UserError("cannot write '" + path_ + "': " + std::strerror(errno));
}

void CsvLog::write(std::int64_t step, double time, std::span<const double> values) {
  on_root(comm_, [&] {
    std::string row = shortest(time) + ',' + std::to_string(step);
    for (const double value : values) (row += ',') += shortest(value);
    append(row + '\n');
  });
}

EnergyLog::EnergyLog(MPI_Comm comm, const std::string& path, bool with_flow)
    : log_(comm, path, energy_names(with_flow)), with_flow_(with_flow) {}

EnergyLog EnergyLog::continue_from(MPI_Comm comm, const std::string& path, double time, bool with_flow) {
  return {CsvLog::continue_from(comm, path, energy_names(with_flow), time), with_flow};
}

void EnergyLog::write(std::int64_t step, double time, const Measurements& measurements) {
  std::vector<double> values;
  for (const auto& column : energy_columns(with_flow_)) values.push_back(column.value(measurements));
  log_.write(step, time, values);
}

ObstacleLog::ObstacleLog(MPI_Comm comm, const std::string& path, Obstacles obstacles)
    : log_(comm, path, obstacle_columns(obstacles)) {}

ObstacleLog ObstacleLog::continue_from(MPI_Comm comm, const std::string& path, Obstacles obstacles,
                                       double time) {
  return ObstacleLog(CsvLog::continue_from(comm, path, obstacle_columns(obstacles), time));
}

void ObstacleLog::begin_at(double time, std::span<const ObstacleImpulse> impulses) {
  last_time_ = time;
  last_.assign(impulses.begin(), impulses.end());
}

void ObstacleLog::write(std::int64_t step, double time, Obstacles obstacles,
                        std::span<const ObstacleImpulse> impulses) {
  last_.resize(impulses.size());
  std::vector<double> values;
  for (std::size_t o = 0; o < impulses.size(); ++o) {
    const auto& state = obstacles[o]->state();
    const double elapsed = time - last_time_;
    const auto force = elapsed > 0 ? (1 / elapsed) * (impulses[o].linear - last_[o].linear) : Vec3d{};
    for (const auto& vector : {impulses[o].linear, impulses[o].angular, force, state.origin, state.velocity,
                               state.angular_velocity})
      values.insert(values.end(), vector.components.begin(), vector.components.end());
  }
  begin_at(time, impulses);
  log_.write(step, time, values);
}

}  // namespace evert
