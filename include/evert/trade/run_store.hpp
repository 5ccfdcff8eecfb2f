#pragma once
#include "evert/trade/measurement.hpp"

#include <mpi.h>

#include <optional>
#include <string>

namespace evert::trade {

/// The records of finished runs, one file each, named by a digest of all that the run depends on: a sweep
/// that was interrupted finds them again.
class RunStore {
 public:
  /// Nothing is written yet.
  explicit RunStore(std::string directory) : directory_(std::move(directory)) {}

  /// Not collective: on rank 0. Empty: there is none, or a broken one.
  [[nodiscard]] std::optional<RunRecord> find(const std::string& identity) const;
  /// Not collective: on rank 0. In one step. Throws UserError where it cannot be written.
  void keep(const std::string& identity, const RunRecord& record) const;

 private:
  [[nodiscard]] std::string path_of(const std::string& identity) const;
  std::string directory_;
};

}  // namespace evert::trade
