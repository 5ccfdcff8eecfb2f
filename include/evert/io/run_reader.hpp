#pragma once
#include "evert/io/hdf5_file.hpp"
#include "evert/mesh/mesh.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Reads a run file back on one rank: for export, viewers and tests.
namespace evert {

/// A frame of a run file.
struct RunFrame {
  std::string group;
  double time = 0;  ///< [s]
  std::int64_t step = 0;
};

/// A rigid obstacle of a run.
struct RunObstacle {
  std::string name;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of its points, counter-clockwise from outside
};

/// An open run file. Not collective. Everything throws UserError when the file is missing, damaged, of
/// another kind or lacks what is asked for.
class RunReader {
 public:
  explicit RunReader(const std::string& path);

  [[nodiscard]] const std::string& path() const { return file_.path(); }
  [[nodiscard]] GlobalIndex node_count() const { return node_count_; }
  [[nodiscard]] GlobalIndex cell_count() const { return cell_count_; }
  [[nodiscard]] const std::vector<RunFrame>& frames() const { return frames_; }

  /// Rest positions, cells and their regions; no node sets.
  [[nodiscard]] Mesh mesh() const;
  /// Whether the ranks of the cells are in the file.
  [[nodiscard]] bool has_ranks() const;
  /// Rank of each cell.
  [[nodiscard]] std::vector<std::int32_t> ranks() const;

  // Of one frame, per node or per cell in the order of mesh().
  [[nodiscard]] std::vector<Vec3d> positions(std::size_t frame) const;     ///< [m]
  [[nodiscard]] std::vector<Vec3d> velocities(std::size_t frame) const;    ///< [m/s]
  [[nodiscard]] std::vector<double> min_stretch(std::size_t frame) const;  ///< [-], negative where inverted
  /// Any field of numbers per cell.
  [[nodiscard]] std::vector<double> cell_field(std::size_t frame, const std::string& name) const;
  [[nodiscard]] std::vector<std::uint8_t> inverted(std::size_t frame) const;

  [[nodiscard]] std::vector<RunObstacle> obstacles() const;
  /// Where the points of an obstacle are in a frame [m].
  [[nodiscard]] std::vector<Vec3d> obstacle_points(std::size_t frame, const RunObstacle& obstacle) const;

  /// Whether a frame has "velocity", "min_stretch" or "inverted".
  [[nodiscard]] bool has(std::size_t frame, const std::string& field) const;

 private:
  void require_format() const;
  void list_cells();
  void list_frames();
  [[nodiscard]] std::string table_of(std::size_t frame, const std::string& field) const;
  [[nodiscard]] std::vector<Vec3d> vectors(const std::string& table) const;
  [[nodiscard]] std::vector<Vec3d> node_vectors(const std::string& table) const;
  template <class T>
  [[nodiscard]] std::vector<T> cell_values(const std::string& table) const;

  Hdf5File file_;
  GlobalIndex node_count_ = 0;
  GlobalIndex cell_count_ = 0;
  std::vector<std::pair<CellType, GlobalIndex>> blocks_;
  std::vector<RunFrame> frames_;
};

}  // namespace evert
