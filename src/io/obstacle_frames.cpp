#include "evert/io/obstacle_frames.hpp"

#include "run_layout.hpp"

namespace evert {
namespace {

constexpr Fineness fineness{.cells = 32};  // a ball of some thousand triangles

/// Rank 0 writes all rows; every rank has them.
template <class T>
void write_on_root(Hdf5File& file, const std::string& table, GlobalIndex rows, const std::vector<T>& values) {
  const bool writes = file.rank() == 0;
  file.write<T>(table, {rows, 3}, {0, writes ? rows : 0},
                writes ? std::span<const T>(values) : std::span<const T>());
}

}  // namespace

ObstacleFrames::ObstacleFrames(std::span<const std::unique_ptr<Obstacle>> obstacles) {
  for (const auto& obstacle : obstacles)
    shown_.push_back({obstacle.get(), triangulate(obstacle->surface(), fineness), {}, ""});
}

std::int64_t ObstacleFrames::bytes() const {
  std::size_t bytes = 0;
  for (const auto& [obstacle, surface, written, table] : shown_)
    bytes += 24 * (surface.points.size() + surface.triangles.size());
  return static_cast<std::int64_t>(bytes);
}

void ObstacleFrames::begin(Hdf5File& file) const {
  if (shown_.empty()) return;
  file.create_group(run_layout::obstacles);
  for (const auto& [obstacle, surface, written, table] : shown_) {
    std::vector<std::int64_t> corners;
    for (const auto& triangle : surface.triangles)
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    file.create_group(run_layout::obstacles + "/" + obstacle->name());
    write_on_root(file, run_layout::triangles_of(obstacle->name()),
                  static_cast<GlobalIndex>(surface.triangles.size()), corners);
  }
}

std::vector<WrittenObstacle> ObstacleFrames::tables() const {
  std::vector<WrittenObstacle> all;
  for (const auto& [obstacle, surface, written, table] : shown_)
    if (!table.empty())
      all.push_back({obstacle->name(), table, static_cast<GlobalIndex>(surface.points.size()),
                     static_cast<GlobalIndex>(surface.triangles.size())});
  return all;
}

std::vector<WrittenObstacle> ObstacleFrames::known(const Hdf5File& file, const std::string& frame) {
  for (auto& shown : shown_)
    if (const auto table = run_layout::points_in(frame, shown.obstacle->name()); file.contains(table))
      shown.table = table;
  return tables();
}

std::vector<WrittenObstacle> ObstacleFrames::write(Hdf5File& file, const std::string& frame) {
  bool begun = false;
  for (auto& [obstacle, surface, written, table] : shown_) {
    auto state = obstacle->state();
    if (!obstacle->is_there()) state = {.rotation = {}};  // shrunk to a point: not seen
    if (written && state.rotation == written->rotation && state.origin == written->origin) continue;
    if (!begun) file.create_group(frame + "/obstacles");
    begun = true;
    table = run_layout::points_in(frame, obstacle->name());
    written = state;
    std::vector<double> places;
    for (const auto& point : surface.points) {
      const auto place = state.to_world(point);
      places.insert(places.end(), place.components.begin(), place.components.end());
    }
    write_on_root(file, table, static_cast<GlobalIndex>(surface.points.size()), places);
  }
  return tables();
}

}  // namespace evert
