#pragma once
#include "evert/io/run_reader.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// The obstacles of a run as its web page shows them. They count little for where the page looks: what is
/// without end, as a half-space, is left out, and what is far away is not waited for.
namespace evert {

struct ShownObstacles {
  std::string surfaces;                   ///< a line an obstacle: triangles (32 bits) in base64
  std::vector<std::string> points;        ///< per frame: all points as 32-bit floats, in base64
  std::vector<std::size_t> point_counts;  ///< per obstacle
  std::vector<Vec3d> corners;             ///< of boxes around them that the page should show
};

/// What they take of the page at most.
struct ObstacleBytes {
  std::size_t fixed = 0, a_frame = 0;
};
[[nodiscard]] ObstacleBytes page_bytes_of_obstacles(const RunReader& run);

/// Of the frames with these numbers. `up`: the axis that points up; `bodies`: the box around what is
/// deformable, upright. Throws UserError where the file is damaged.
[[nodiscard]] ShownObstacles shown_obstacles(const RunReader& run, std::span<const std::size_t> frames,
                                             std::size_t up, const std::pair<Vec3d, Vec3d>& bodies);

}  // namespace evert
