#include "mesh_size.hpp"

#include "evert/core/error.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <unistd.h>

namespace evert {

void require_possible_size(double cells, double nodes) {
  constexpr double most_cells = 2147483648.0;
  constexpr double bytes_per_cell =
      4 * 8 + 4 + 4 * 40;  // nodes and region, and four faces to find the surface
  constexpr double bytes_per_node = 2 * 3 * 8;
  constexpr double gigabyte = 1e9;
  const double needed = (cells * bytes_per_cell + nodes * bytes_per_node) / gigabyte;
  const double present =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE)) / gigabyte;
  if (cells <= most_cells && needed <= present) return;
  std::array<char, 240> text{};
  std::snprintf(
      text.data(), text.size(),
      "the mesh would have about %.3g cells and take %.3g GB, but at most 2^31 cells and the %.3g GB of "
      "this machine are allowed: choose a larger edge_length",
      cells, needed, present);
  throw UserError(text.data());
}

}  // namespace evert
