#include "evert/io/run_reader.hpp"

#include "evert/core/error.hpp"

#include "run_layout.hpp"
#include <algorithm>
#include <limits>

namespace evert {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw UserError("'" + path + "' is not a usable run file: " + reason);
}

}  // namespace

RunReader::RunReader(const std::string& path)
    : file_(Hdf5File::open(MPI_COMM_SELF, path, Hdf5File::Access::read)) {
  require_format();
  const auto nodes = file_.shape_of(run_layout::rest_positions);
  if (nodes.width != 3) refuse(path, "positions do not have three components");
  node_count_ = nodes.rows;
  list_cells();
  list_frames();
}

void RunReader::require_format() const {
  std::string format;
  try {
    format = file_.attribute<std::string>("/", "format");
  } catch (const UserError&) {
    refuse(file_.path(), "it was not written by evert");
  }
  if (format != run_layout::format) refuse(file_.path(), "it is an " + format + " file");
  const auto version = file_.attribute<std::int64_t>("/", "format_version");
  if (version != run_layout::format_version)
    refuse(file_.path(), "its format has version " + std::to_string(version) + ", this evert reads version " +
                             std::to_string(run_layout::format_version));
}

void RunReader::list_cells() {
  for (const auto type : all_cell_types) {
    const auto table = run_layout::cells(type);
    if (!file_.contains(table)) continue;
    const auto shape = file_.shape_of(table);
    if (shape.width != evert::node_count(type))
      refuse(file_.path(), "'" + table + "' has another number of nodes");
    blocks_.emplace_back(type, shape.rows);
    cell_count_ += shape.rows;
  }
}

void RunReader::list_frames() {
  for (const auto& name : file_.names_in("/frames")) {
    const auto group = "/frames/" + name;
    frames_.push_back(
        {group, file_.attribute<double>(group, "time"), file_.attribute<std::int64_t>(group, "step")});
  }
}

Mesh RunReader::mesh() const {
  Mesh mesh;
  mesh.nodes = node_vectors(run_layout::rest_positions);
  mesh.regions = file_.attribute<std::vector<std::string>>("/mesh", "regions");
  const auto regions = cell_values<std::int32_t>(run_layout::region);
  const auto known = [&](std::int32_t region) {
    return region >= 0 && static_cast<std::size_t>(region) < mesh.regions.size();
  };
  if (!std::all_of(regions.begin(), regions.end(), known)) refuse(file_.path(), "a cell lies in no region");
  auto region = regions.begin();
  for (const auto& [type, count] : blocks_) {
    CellBlock block{type, file_.read<std::int64_t>(run_layout::cells(type), {0, count}), {}};
    const auto exists = [&](GlobalIndex node) { return node >= 0 && node < node_count_; };
    if (!std::all_of(block.nodes.begin(), block.nodes.end(), exists))
      refuse(file_.path(), "a cell has a node that does not exist");
    block.region.assign(region, region + count);
    region += count;
    mesh.cells.push_back(std::move(block));
  }
  return mesh;
}

bool RunReader::has_ranks() const { return file_.contains(run_layout::rank); }

std::vector<std::int32_t> RunReader::ranks() const { return cell_values<std::int32_t>(run_layout::rank); }

std::vector<Vec3d> RunReader::positions(std::size_t frame) const {
  return node_vectors(table_of(frame, "positions"));
}

std::vector<Vec3d> RunReader::velocities(std::size_t frame) const {
  return node_vectors(table_of(frame, "velocity"));
}

std::vector<double> RunReader::min_stretch(std::size_t frame) const {
  return cell_values<double>(table_of(frame, "min_stretch"));
}

std::vector<double> RunReader::cell_field(std::size_t frame, const std::string& name) const {
  return cell_values<double>(table_of(frame, name));
}

std::vector<std::uint8_t> RunReader::inverted(std::size_t frame) const {
  return cell_values<std::uint8_t>(table_of(frame, "inverted"));
}

bool RunReader::has(std::size_t frame, const std::string& field) const {
  return frame < frames_.size() && file_.contains(frames_[frame].group + "/" + field);
}

std::string RunReader::table_of(std::size_t frame, const std::string& field) const {
  if (frame >= frames_.size())
    throw UserError("'" + file_.path() + "' has no frame " + std::to_string(frame) + ": it has " +
                    std::to_string(frames_.size()));
  if (!has(frame, field))
    throw UserError("frame " + std::to_string(frame) + " of '" + file_.path() + "' has no field '" + field +
                    "'");
  return frames_[frame].group + "/" + field;
}

std::vector<Vec3d> RunReader::vectors(const std::string& table) const {
  const auto shape = file_.shape_of(table);
  if (shape.width != 3) refuse(file_.path(), "'" + table + "' does not have three values in a row");
  const auto values = file_.read<double>(table, {0, shape.rows});
  std::vector<Vec3d> result(static_cast<std::size_t>(shape.rows));
  for (std::size_t i = 0; i < values.size(); ++i) result[i / 3][i % 3] = values[i];
  return result;
}

std::vector<Vec3d> RunReader::node_vectors(const std::string& table) const {
  if (file_.shape_of(table) != TableShape{node_count_, 3})
    refuse(file_.path(), "'" + table + "' does not have three values for every node");
  return vectors(table);
}

std::vector<RunObstacle> RunReader::obstacles() const {
  std::vector<RunObstacle> all;
  if (!file_.contains(run_layout::obstacles)) return all;
  for (const auto& name : file_.names_in(run_layout::obstacles)) {
    const auto table = run_layout::triangles_of(name);
    const auto shape = file_.shape_of(table);
    if (shape.width != 3) refuse(file_.path(), "'" + table + "' does not have three values in a row");
    auto& obstacle = all.emplace_back(RunObstacle{name, {}});
    obstacle.triangles.resize(static_cast<std::size_t>(shape.rows));
    const auto corners = file_.read<std::int64_t>(table, {0, shape.rows});
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i] < 0 || corners[i] > std::numeric_limits<std::int32_t>::max())
        refuse(file_.path(), "a triangle of '" + name + "' has a point that does not exist");
      obstacle.triangles[i / 3][i % 3] = static_cast<std::uint32_t>(corners[i]);
    }
  }
  return all;
}

std::vector<Vec3d> RunReader::obstacle_points(std::size_t frame, const RunObstacle& obstacle) const {
  for (auto last = frame + 1; last-- > 0;) {  // where it stood still, the frame has no table
    const auto table = run_layout::points_in(frames_.at(last).group, obstacle.name);
    if (!file_.contains(table)) continue;
    auto points = vectors(table);
    for (const auto& triangle : obstacle.triangles)
      for (const auto corner : triangle)
        if (corner >= points.size())
          refuse(file_.path(), "a triangle of '" + obstacle.name + "' has a point that does not exist");
    return points;
  }
  refuse(file_.path(), "no frame says where '" + obstacle.name + "' is");
}

template <class T>
std::vector<T> RunReader::cell_values(const std::string& table) const {
  if (file_.shape_of(table) != TableShape{cell_count_, 1})
    refuse(file_.path(), "'" + table + "' does not have one value for every cell");
  return file_.read<T>(table, {0, cell_count_});
}

}  // namespace evert
