#pragma once
#include "evert/contact/obstacle.hpp"
#include "evert/io/hdf5_file.hpp"
#include "evert/shapes/triangle_surface.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace evert {

/// A table of a run file that holds where the points of an obstacle are, and the sizes of its surface.
struct WrittenObstacle {
  std::string name;
  std::string points;  ///< the table: of the frame, or of the last frame before in which it had moved
  GlobalIndex point_count = 0;
  GlobalIndex triangle_count = 0;
};

/// The surfaces of obstacles in a run file: the triangles once, below /obstacles/<name>/triangles
/// [triangles, 3], and the places of their points [points, 3] [m] in every frame in which an obstacle stands
/// elsewhere than in the one before, below /frames/<number>/obstacles/<name>. Every call is collective.
class ObstacleFrames {
 public:
  /// `obstacles` must outlive this.
  explicit ObstacleFrames(std::span<const std::unique_ptr<Obstacle>> obstacles);

  /// Writes the triangles of a new file.
  void begin(Hdf5File& file) const;
  /// What a frame of an earlier run says; to be called in the order of the frames.
  [[nodiscard]] std::vector<WrittenObstacle> known(const Hdf5File& file, const std::string& frame);
  /// Writes where the obstacles are now.
  [[nodiscard]] std::vector<WrittenObstacle> write(Hdf5File& file, const std::string& frame);

  /// Bytes that begin() or write() need at most.
  [[nodiscard]] std::int64_t bytes() const;

 private:
  struct Shown {
    const Obstacle* obstacle;
    TriangleSurface surface;            // in the frame of the obstacle
    std::optional<RigidState> written;  // of the last table, where this process wrote it
    std::string table;                  // "" before the first
  };
  [[nodiscard]] std::vector<WrittenObstacle> tables() const;
  std::vector<Shown> shown_;
};

}  // namespace evert
