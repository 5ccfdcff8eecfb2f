#pragma once
#include "evert/sim/simulation.hpp"

#include <mpi.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace evert {

/// A file of comma-separated values: one row for each call, headed by names and units, on the disk when the
/// call returns. The first column is the time [s], the second the step. Every call is collective; what cannot
/// be written is a UserError on all ranks.
class CsvLog {
 public:
  /// Begins a new file. `columns`: the names of those after the second.
  CsvLog(MPI_Comm comm, const std::string& path, const std::vector<std::string>& columns);
  /// Goes on with the log of an earlier run, without its rows after `time` [s]. Throws UserError when the
  /// file has other columns; begins a new one where there is none.
  [[nodiscard]] static CsvLog continue_from(MPI_Comm comm, const std::string& path,
                                            const std::vector<std::string>& columns, double time);

  /// The values of rank 0 count.
  void write(std::int64_t step, double time, std::span<const double> values);

 private:
  CsvLog(MPI_Comm comm, const std::string& path, const std::string& begin);
  void append(const std::string& text);

  struct Close {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
  };
  MPI_Comm comm_;
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;  // on rank 0
};

/// The log of energies, momenta and impulses, and `with_flow` of the work on plastic flow and how far it is
/// from its goal. Collective, as CsvLog.
class EnergyLog {
 public:
  EnergyLog(MPI_Comm comm, const std::string& path, bool with_flow = false);
  [[nodiscard]] static EnergyLog continue_from(MPI_Comm comm, const std::string& path, double time,
                                               bool with_flow = false);
  void write(std::int64_t step, double time, const Measurements& measurements);

 private:
  EnergyLog(CsvLog log, bool with_flow) : log_(std::move(log)), with_flow_(with_flow) {}
  CsvLog log_;
  bool with_flow_;
};

/// What each obstacle gave to nodes and rigid bodies, and where it is. Collective, as CsvLog.
class ObstacleLog {
 public:
  using Obstacles = std::span<const std::unique_ptr<Obstacle>>;
  ObstacleLog(MPI_Comm comm, const std::string& path, Obstacles obstacles);
  [[nodiscard]] static ObstacleLog continue_from(MPI_Comm comm, const std::string& path, Obstacles obstacles,
                                                 double time);
  /// `impulses` since the start of the run. Forces are their change since the last call, per time.
  void write(std::int64_t step, double time, Obstacles obstacles, std::span<const ObstacleImpulse> impulses);
  /// Where a restarted run begins: what the force of the first row counts from. Not collective.
  void begin_at(double time, std::span<const ObstacleImpulse> impulses);

 private:
  explicit ObstacleLog(CsvLog log) : log_(std::move(log)) {}
  CsvLog log_;
  double last_time_ = 0;  // [s]
  std::vector<ObstacleImpulse> last_;
};

}  // namespace evert
