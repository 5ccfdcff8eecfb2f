#pragma once
#include "evert/io/hdf5_file.hpp"
#include "evert/io/natural_order.hpp"
#include "evert/io/obstacle_frames.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

/// The frames of a run, for ParaView and for our own readers: run.h5, and run.xdmf beside it.
///
/// run.h5 holds, in the order of the undistributed mesh without its unused nodes:
///   /mesh/rest_positions [nodes, 3] [m]   /mesh/cells/<type> [cells of the type, nodes of a cell]
///   /mesh/region, /mesh/rank [cells]      /mesh/mixed: all cells as XDMF wants them, with several types only
///   /frames/<number>/positions [nodes, 3] [m], velocity [nodes, 3] [m/s], min_stretch [cells] [-],
///   inverted [cells] 0 or 1, plastic_strain, plastic_volume [cells] [-]; attributes time [s] and step
/// and the surfaces of the obstacles, as obstacle_frames.hpp says.
namespace evert {

class Simulation;

/// What is written besides the positions.
struct FrameFields {
  bool velocity = true;
  bool min_stretch = true;
  bool inversion = true;
  bool rank = true;
  bool plastic_strain = false;
  bool plastic_volume = false;
};

/// What one frame shows, by reference.
struct FrameSource {
  double time = 0;  ///< [s]
  std::int64_t step = 0;
  const NodeField& positions;   ///< [m]
  const NodeField& velocities;  ///< [m/s]
  /// Fills a number per cell of DistributedMesh::cells[block].
  using CellValues = std::function<void(std::size_t block, std::span<double> per_cell)>;
  CellValues min_stretch;       ///< smallest signed principal stretch
  CellValues plastic_strain{};  ///< as in tension; leaves cells that cannot flow as they are
  CellValues plastic_volume{};  ///< det F_p; the same
};

/// The present state of a simulation, which must outlive the result.
[[nodiscard]] FrameSource frame_source(const Simulation& simulation);

/// A frame that is in the file.
struct WrittenFrame {
  std::string group;
  double time = 0;  ///< [s]
  FrameFields fields;
  std::vector<WrittenObstacle> obstacles{};
};

/// Writes frames together with all ranks. After each frame both files are complete on disk: a run that dies,
/// or finds the disk full, leaves all earlier frames readable. Every call is collective; what cannot be
/// written is a UserError on all ranks.
class FrameWriter {
 public:
  using Obstacles = std::span<const std::unique_ptr<Obstacle>>;
  /// Begins a new file at `path`, which ends in .h5. `mesh` and `obstacles` must outlive the writer.
  FrameWriter(const DistributedMesh& mesh, const std::string& path, const FrameFields& fields,
              Obstacles obstacles = {});
  /// Goes on with the file of an earlier run of the same mesh, without its frames after `time` [s]; begins a
  /// new one where there is none.
  [[nodiscard]] static FrameWriter continue_from(const DistributedMesh& mesh, const std::string& path,
                                                 const FrameFields& fields, double time,
                                                 Obstacles obstacles = {});

  void write(const FrameSource& source);
  [[nodiscard]] std::span<const WrittenFrame> frames() const { return frames_; }
  /// Where the XDMF companion lies.
  [[nodiscard]] std::string xdmf_path() const;

 private:
  FrameWriter(const DistributedMesh& mesh, Hdf5File file, const FrameFields& fields, Obstacles obstacles);
  void write_mesh();
  void write_connectivity();
  void write_ranks(bool anew);
  void write_nodes(const std::string& table, const NodeField& field);
  template <class T>
  void write_cells(const std::string& table, const std::vector<T>& values);
  [[nodiscard]] std::vector<double> cell_values(const FrameSource::CellValues& of_block,
                                                double otherwise) const;
  void write_stretches(const std::string& group, const FrameSource& source);
  void write_xdmf() const;
  void reserve(std::int64_t bytes) const;
  [[nodiscard]] std::int64_t frame_bytes() const;

  const DistributedMesh& mesh_;
  FrameFields fields_;
  NaturalOrder nodes_;
  NaturalOrder cells_;
  std::vector<std::pair<CellType, GlobalIndex>> blocks_;  // types present and their cells on all ranks
  ObstacleFrames obstacles_;
  Hdf5File file_;
  std::vector<WrittenFrame> frames_;
};

}  // namespace evert
