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
    Column{"total_energy [J]", [](const Measurements& m) { return m.kinetic_energy + m.elastic_energy + m.gravitational_energy; }},
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
// clang-format on

std::string header() {
  std::string text = "time [s],step";
  for (const auto& column : columns) (text += ',') += column.name;
  return text + '\n';
}

/// The first value of a row.
double time_of(std::string_view row) {
  double time = 0;
  std::from_chars(row.data(), row.data() + row.size(), time);
  return time;
}

/// Header and rows up to `time` of the log at `path`; a last row cut by a kill is left out.
std::string rows_until(const std::string& path, double time) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return header();
  std::string line;
  if (!std::getline(file, line) || line + '\n' != header())
    throw UserError("cannot continue '" + path + "': it is not an energy log with the columns of this evert");
  std::string kept = header();
  while (std::getline(file, line) && !file.eof() && time_of(line) <= time) (kept += line) += '\n';
  return kept;
}

}  // namespace

EnergyLog::EnergyLog(MPI_Comm comm, const std::string& path) : EnergyLog(comm, path, header()) {}

EnergyLog::EnergyLog(MPI_Comm comm, const std::string& path, const std::string& begin)
    : comm_(comm), path_(path) {
  on_root(comm_, [&] {
    require_writable(path_);
    file_.reset(std::fopen(path_.c_str(), "wb"));
    if (!file_) throw UserError("cannot write '" + path_ + "': " + std::strerror(errno));
    append(begin);
  });
}

EnergyLog EnergyLog::continue_from(MPI_Comm comm, const std::string& path, double time) {
  std::string begin;
  on_root(comm, [&] { begin = rows_until(path, time); });
  return {comm, path, begin};
}

void EnergyLog::append(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0)
    throw UserError("cannot write '" + path_ + "': " + std::strerror(errno));
}

void EnergyLog::write(std::int64_t step, double time, const Measurements& measurements) {
  on_root(comm_, [&] {
    std::string row = shortest(time) + ',' + std::to_string(step);
    for (const auto& column : columns) (row += ',') += shortest(column.value(measurements));
    append(row + '\n');
  });
}

}  // namespace evert
