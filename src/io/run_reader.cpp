#include "evert/io/run_reader.hpp"

#include "evert/core/error.hpp"

#include "run_layout.hpp"
#include <algorithm>

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

std::vector<Vec3d> RunReader::node_vectors(const std::string& table) const {
  if (file_.shape_of(table) != TableShape{node_count_, 3})
    refuse(file_.path(), "'" + table + "' does not have three values for every node");
  const auto values = file_.read<double>(table, {0, node_count_});
  std::vector<Vec3d> vectors(static_cast<std::size_t>(node_count_));
  for (std::size_t i = 0; i < values.size(); ++i) vectors[i / 3][i % 3] = values[i];
  return vectors;
}

template <class T>
std::vector<T> RunReader::cell_values(const std::string& table) const {
  if (file_.shape_of(table) != TableShape{cell_count_, 1})
    refuse(file_.path(), "'" + table + "' does not have one value for every cell");
  return file_.read<T>(table, {0, cell_count_});
}

}  // namespace evert
