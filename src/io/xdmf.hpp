#pragma once
#include "evert/io/frame_writer.hpp"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace evert {

/// What an XDMF file says about a run file.
struct XdmfRun {
  std::string hdf5_name;  ///< beside the XDMF file
  GlobalIndex nodes = 0;
  std::vector<std::pair<CellType, GlobalIndex>> blocks;  ///< cells of each type, in the order of the file
};

/// The text: a temporal collection of grids.
[[nodiscard]] std::string xdmf_text(const XdmfRun& run, std::span<const WrittenFrame> frames);

/// Length of the table /mesh/mixed: a code and the nodes of each cell.
[[nodiscard]] GlobalIndex mixed_length(std::span<const std::pair<CellType, GlobalIndex>> blocks);

}  // namespace evert
