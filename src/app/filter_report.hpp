#pragma once
#include "evert/filter/modal_filter.hpp"

#include <string>
#include <vector>

namespace evert {

/// Collective over `comm`, the ranks of the filter. What it does, and of an automatic step a line for every
/// one that was looked at.
[[nodiscard]] std::vector<std::string> filter_lines(MPI_Comm comm, const ModalFilter& filter);

}  // namespace evert
