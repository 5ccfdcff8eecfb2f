#pragma once
#include "evert/sim/simulation.hpp"

#include <mpi.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace evert {

/// The log of energies and momenta: one row of comma-separated values for each call, headed by names and
/// units, on the disk when the call returns. Every call is collective; what cannot be written is a UserError
/// on all ranks.
class EnergyLog {
 public:
  /// Begins a new file.
  EnergyLog(MPI_Comm comm, const std::string& path);
  /// Goes on with the log of an earlier run, without its rows after `time` [s]. Throws UserError when the
  /// file has other columns; begins a new one where there is none.
  [[nodiscard]] static EnergyLog continue_from(MPI_Comm comm, const std::string& path, double time);

  void write(std::int64_t step, double time, const Measurements& measurements);

 private:
  EnergyLog(MPI_Comm comm, const std::string& path, const std::string& begin);
  void append(const std::string& text);

  struct Close {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
  };
  MPI_Comm comm_;
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;  // on rank 0
};

}  // namespace evert
