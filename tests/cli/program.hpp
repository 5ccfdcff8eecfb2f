#pragma once
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

/// Runs the real program as a user would, and catches what it says.
namespace evert::cli {

struct Outcome {
  int exit_code = -1;      ///< 128 + signal when a signal ended it
  bool timed_out = false;  ///< did not end in time and was killed
  std::string output;      ///< standard output of all ranks
  std::vector<std::string>
      errors;  ///< lines that the ranks wrote to standard error; mpirun's own are left out
};

/// Runs `evert <arguments>` in the directory `place`: as it is for one rank, else under mpirun.
[[nodiscard]] Outcome run_evert(const std::vector<std::string>& arguments, int ranks,
                                const std::filesystem::path& place, std::chrono::seconds limit);

/// Splits at spaces; a part in single quotes stays whole, without the quotes.
[[nodiscard]] std::vector<std::string> split(const std::string& command);

}  // namespace evert::cli
