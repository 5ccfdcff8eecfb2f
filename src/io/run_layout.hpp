#pragma once
#include "evert/io/frame_writer.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// Names in a run file, shared by who writes and who reads it.
namespace evert::run_layout {

inline const std::string format = "evert run";
inline constexpr std::int64_t format_version = 1;

inline const std::string rest_positions = "/mesh/rest_positions";
inline const std::string region = "/mesh/region";
inline const std::string rank = "/mesh/rank";
inline const std::string mixed = "/mesh/mixed";

inline const std::string obstacles = "/obstacles";

[[nodiscard]] inline std::string triangles_of(const std::string& obstacle) {
  return obstacles + "/" + obstacle + "/triangles";
}
/// Not in every frame: where there is none, the last one before holds.
[[nodiscard]] inline std::string points_in(const std::string& frame, const std::string& obstacle) {
  return frame + "/obstacles/" + obstacle;
}

[[nodiscard]] inline std::string cells(CellType type) { return "/mesh/cells/" + std::string(name_of(type)); }

/// "/frames/00000012": sorted by name is sorted by number.
[[nodiscard]] inline std::string frame(std::size_t number) {
  const auto digits = std::to_string(number);
  return "/frames/" + std::string(digits.size() < 8 ? 8 - digits.size() : 0, '0') + digits;
}

/// XDMF's code of a cell type.  Xdmf 3, XdmfTopologyType
[[nodiscard]] inline std::int64_t xdmf_code(CellType type) {
  switch (type) {
    case CellType::tet4:
      return 6;
    case CellType::wedge6:
      return 8;
    case CellType::hex8:
      return 9;
    case CellType::tet10:
      return 38;
  }
  return 0;
}

}  // namespace evert::run_layout
