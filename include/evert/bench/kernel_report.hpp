#pragma once
#include "evert/bench/kernels.hpp"

#include <ostream>
#include <string>
#include <vector>

/// What `evert bench` says about the machine and the kernels, for people and for programs.
namespace evert::bench {

/// Where and when something was measured.
struct Setting {
  int ranks = 1;
  std::string machine;    ///< model of the processor, or "unknown"
  std::string cpu_level;  ///< of the kernels
  std::string date;       ///< UTC, ISO 8601
};
[[nodiscard]] Setting current_setting(MPI_Comm comm);

struct KernelReport {
  Setting setting;
  std::vector<KernelSizeReport> sizes;
};

/// One table a size, with its ceilings.
void print_head(const Setting& setting, std::ostream& out);
void print_table(const KernelSizeReport& report, std::ostream& out);

/// Rates by kernel and size, in millions of items per second.
[[nodiscard]] std::string json_text(const KernelReport& report);

}  // namespace evert::bench
