#include "evert/io/summary.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/log.hpp"
#include "evert/core/version.hpp"
#include "evert/io/files.hpp"
#include "evert/io/json_text.hpp"

#include <hdf5.h>
#include <petscsys.h>

#include <array>
#include <sys/resource.h>
#include <vector>

namespace evert {
namespace {

std::string dotted(unsigned major, unsigned minor, unsigned patch) {
  return std::to_string(major) + '.' + std::to_string(minor) + '.' + std::to_string(patch);
}

JsonValue versions() {
  PetscInt petsc_major = 0;
  PetscInt petsc_minor = 0;
  PetscInt petsc_patch = 0;
  static_cast<void>(PetscGetVersionNumber(&petsc_major, &petsc_minor, &petsc_patch, nullptr));
  unsigned hdf5_major = 0;
  unsigned hdf5_minor = 0;
  unsigned hdf5_patch = 0;
  static_cast<void>(H5get_libversion(&hdf5_major, &hdf5_minor, &hdf5_patch));
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> mpi{};
  int length = 0;
  MPI_Get_library_version(mpi.data(), &length);
  const std::string mpi_text(mpi.data());
  return JsonValue::object(
      {{"evert", version()},
       {"petsc", dotted(static_cast<unsigned>(petsc_major), static_cast<unsigned>(petsc_minor),
                        static_cast<unsigned>(petsc_patch))},
       {"mpi", mpi_text.substr(0, mpi_text.find(','))},
       {"hdf5", dotted(hdf5_major, hdf5_minor, hdf5_patch)}});
}

JsonValue phases(const PhaseTimes& times) {
  std::vector<std::pair<std::string, JsonValue>> members;
  for (std::size_t phase = 0; phase < phase_count; ++phase)
    members.emplace_back(name_of(static_cast<Phase>(phase)),
                         JsonValue::object({{"mean", times.mean[phase]}, {"max", times.max[phase]}}));
  return JsonValue::object(members);
}

/// Collective.
JsonValue memory_by_rank(MPI_Comm comm) {
  const std::int64_t mine = peak_memory();
  std::vector<std::int64_t> all(static_cast<std::size_t>(size_of(comm)));
  MPI_Allgather(&mine, 1, MPI_INT64_T, all.data(), 1, MPI_INT64_T, comm);
  return JsonValue::list({all.begin(), all.end()});
}

JsonValue vector3(const Vec3d& v) { return JsonValue::list({v[0], v[1], v[2]}); }

JsonValue final_state(const Measurements& m) {
  return JsonValue::object({{"kinetic_energy", m.kinetic_energy},
                            {"elastic_energy", m.elastic_energy},
                            {"gravitational_energy", m.gravitational_energy},
                            {"total_energy", m.total_energy()},
                            {"momentum", vector3(m.momentum)},
                            {"angular_momentum", vector3(m.angular_momentum)},
                            {"gravity_impulse", vector3(m.gravity_impulse)},
                            {"contact_impulse", vector3(m.contact_impulse)},
                            {"constraint_impulse", vector3(m.constraint_impulse)},
                            {"damping_impulse", vector3(m.damping_impulse)},
                            {"inverted_points", m.inverted_points}});
}

JsonValue obstacles(const RunSummary& summary) {
  std::vector<std::pair<std::string, JsonValue>> members;
  for (const auto& [name, given] : summary.obstacles)
    members.emplace_back(name, JsonValue::object({{"impulse", vector3(given.linear)},
                                                  {"angular_impulse", vector3(given.angular)}}));
  return JsonValue::object(members);
}

JsonValue shape_errors(const RunSummary& summary) {
  std::vector<std::pair<std::string, JsonValue>> members;
  for (const auto& [body, error] : summary.shape_errors) members.emplace_back(body, error);
  return JsonValue::object(members);
}

}  // namespace

PhaseTimes phase_times(MPI_Comm comm) {
  const auto& mine = phase_seconds();
  PhaseTimes times;
  MPI_Allreduce(mine.data(), times.mean.data(), phase_count, MPI_DOUBLE, MPI_SUM, comm);
  MPI_Allreduce(mine.data(), times.max.data(), phase_count, MPI_DOUBLE, MPI_MAX, comm);
  for (double& seconds : times.mean) seconds /= size_of(comm);
  return times;
}

std::int64_t peak_memory() {
  rusage usage{};
  static_cast<void>(getrusage(RUSAGE_SELF, &usage));
  return std::int64_t{usage.ru_maxrss} * 1024;  // Linux counts in kilobytes
}

void write_summary(MPI_Comm comm, const std::string& path, const RunSummary& summary) {
  const auto memory = memory_by_rank(comm);
  on_root(comm, [&] {
    const auto json = JsonValue::object(
        {{"scene", summary.scene},
         {"outcome", summary.outcome},
         {"ranks", size_of(comm)},
         {"nodes", summary.nodes},
         {"cells", summary.cells},
         {"quadrature_points", summary.quadrature_points},
         {"steps", summary.steps},
         {"frames", summary.frames},
         {"cg_iterations", summary.cg_iterations},
         {"snes_iterations", summary.newton_iterations},
         {"ksp_iterations", summary.linear_iterations},
         {"simulated_seconds", summary.simulated_time},
         {"wall_seconds", summary.wall_time},
         {"phase_seconds", phases(summary.phases)},
         {"max_inverted",
          JsonValue::object({{"points", summary.max_inverted_points}, {"time", summary.max_inverted_time}})},
         {"final", final_state(summary.final_state)},
         {"obstacles", obstacles(summary)},
         {"shape_error", shape_errors(summary)},
         {"peak_memory_bytes", memory},
         {"cpu_level", summary.cpu_level},
         {"versions", versions()}});
    write_file(path, json.text() + '\n');
  });
}

}  // namespace evert
