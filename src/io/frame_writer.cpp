#include "evert/io/frame_writer.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/log.hpp"
#include "evert/io/files.hpp"
#include "evert/io/run_reader.hpp"

#include "run_layout.hpp"
#include "tables.hpp"
#include "xdmf.hpp"
#include <algorithm>
#include <array>
#include <filesystem>

namespace evert {
namespace {

std::vector<std::pair<CellType, GlobalIndex>> count_blocks(const DistributedMesh& mesh) {
  std::array<GlobalIndex, all_cell_types.size()> counts{};
  for (const auto& cells : mesh.cells) counts[static_cast<std::size_t>(cells.type)] += cells.size();
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), static_cast<int>(counts.size()), MPI_INT64_T, MPI_SUM,
                mesh.comm);
  std::vector<std::pair<CellType, GlobalIndex>> blocks;
  for (const auto type : all_cell_types)
    if (const auto count = counts[static_cast<std::size_t>(type)]; count > 0)
      blocks.emplace_back(type, count);
  return blocks;
}

Hdf5File begin_file(MPI_Comm comm, const std::string& path) {
  on_root(comm, [&] { require_writable(path); });
  return Hdf5File::create(comm, path);
}

/// The natural numbers of the nodes of every local node: ghosts' come from their owners.
std::vector<GlobalIndex> natural_of_local_nodes(const DistributedMesh& mesh) {
  // Through a field, in which a number up to 2^53 is exact.
  NodeField numbers(mesh);
  for (std::size_t i = 0; i < mesh.natural_nodes.size(); ++i)
    numbers.owned()[3 * i] = static_cast<double>(mesh.natural_nodes[i]);
  numbers.touched();
  const Halo halo(mesh);
  halo.begin_update(numbers);
  halo.end_update(numbers);
  std::vector<GlobalIndex> result;
  for (std::size_t i = 0; i < numbers.local().size(); i += 3)
    result.push_back(static_cast<GlobalIndex>(numbers.local()[i]));
  return result;
}

/// Collective: rank 0 looks.
bool exists(MPI_Comm comm, const std::string& path) {
  int found = 0;
  on_root(comm, [&] { found = std::filesystem::exists(path) ? 1 : 0; });
  MPI_Bcast(&found, 1, MPI_INT, 0, comm);
  return found == 1;
}

/// Throws UserError unless the file can go on with this mesh. Not collective.
void require_run_of(const DistributedMesh& mesh, const std::string& path) {
  require_writable(path);
  const RunReader run(path);
  if (run.node_count() == mesh.total_nodes && run.cell_count() == mesh.total_cells) return;
  throw UserError("cannot continue '" + path + "': it has " + std::to_string(run.node_count()) +
                  " nodes and " + std::to_string(run.cell_count()) + " cells, the mesh has " +
                  std::to_string(mesh.total_nodes) + " and " + std::to_string(mesh.total_cells));
}

}  // namespace

FrameWriter::FrameWriter(const DistributedMesh& mesh, Hdf5File file, const FrameFields& fields,
                         Obstacles obstacles)
    : mesh_(mesh),
      fields_(fields),
      nodes_(natural_node_order(mesh)),
      cells_(natural_cell_order(mesh)),
      blocks_(count_blocks(mesh)),
      obstacles_(obstacles),
      file_(std::move(file)) {}

FrameWriter::FrameWriter(const DistributedMesh& mesh, const std::string& path, const FrameFields& fields,
                         Obstacles obstacles)
    : FrameWriter(mesh, begin_file(mesh.comm, path), fields, obstacles) {
  const PhaseScope phase(Phase::io);
  write_mesh();
  write_xdmf();
}

FrameWriter FrameWriter::continue_from(const DistributedMesh& mesh, const std::string& path,
                                       const FrameFields& fields, double time, Obstacles obstacles) {
  if (!exists(mesh.comm, path)) return {mesh, path, fields, obstacles};
  const PhaseScope phase(Phase::io);
  on_root(mesh.comm, [&] { require_run_of(mesh, path); });
  FrameWriter writer(mesh, Hdf5File::open(mesh.comm, path, Hdf5File::Access::write), fields, obstacles);
  for (const auto& name : writer.file_.names_in("/frames")) {
    const std::string group = "/frames/" + name;
    const auto written = writer.file_.attribute<double>(group, "time");
    if (written > time) {
      writer.file_.remove(group);
      continue;
    }
    const auto has = [&](const char* table) { return writer.file_.contains(group + "/" + table); };
    writer.frames_.push_back(
        {group,
         written,
         {has("velocity"), has("min_stretch"), has("inverted"), writer.file_.contains(run_layout::rank),
          has("plastic_strain"), has("plastic_volume")},
         writer.obstacles_.known(writer.file_, group)});
  }
  writer.write_ranks(false);
  writer.file_.flush();
  writer.write_xdmf();
  return writer;
}

std::string FrameWriter::xdmf_path() const {
  return std::filesystem::path(file_.path()).replace_extension(".xdmf").string();
}

void FrameWriter::reserve(std::int64_t bytes) const {
  on_root(mesh_.comm, [&] { reserve_space(file_.path(), bytes + metadata_allowance); });
}

void FrameWriter::write_mesh() {
  const auto cells = mesh_.total_cells;
  std::int64_t connectivity = mixed_length(blocks_) * 8 * (blocks_.size() > 1 ? 2 : 1);
  reserve(mesh_.total_nodes * 24 + connectivity + cells * 8 + obstacles_.bytes());
  file_.set_attribute("/", "format", run_layout::format);
  file_.set_attribute("/", "format_version", run_layout::format_version);
  file_.create_group("/mesh");
  file_.create_group("/mesh/cells");
  file_.create_group("/frames");
  file_.set_attribute("/mesh", "regions", mesh_.regions);

  std::vector<double> rest;
  for (LocalIndex i = 0; i < mesh_.owned_nodes; ++i)
    for (std::size_t c = 0; c < 3; ++c) rest.push_back(mesh_.rest_positions[static_cast<std::size_t>(i)][c]);
  file_.write<double>(run_layout::rest_positions, {nodes_.total(), 3}, rows_of(nodes_),
                      nodes_.to_slices<double>(rest, 3));
  write_connectivity();
  std::vector<std::int32_t> regions;
  for (const auto& list : mesh_.cells) regions.insert(regions.end(), list.global_ids.size(), list.region);
  write_cells(run_layout::region, regions);
  write_ranks(true);
  obstacles_.begin(file_);
  file_.flush();
}

void FrameWriter::write_connectivity() {
  const auto natural = natural_of_local_nodes(mesh_);
  const bool mixed = blocks_.size() > 1;
  if (mixed) file_.write<std::int64_t>(run_layout::mixed, {mixed_length(blocks_), 1}, {}, {});
  GlobalIndex cells_before = 0;
  GlobalIndex values_before = 0;
  for (const auto& [type, count] : blocks_) {
    const auto width = static_cast<std::size_t>(node_count(type));
    std::vector<GlobalIndex> numbers;
    std::vector<std::int64_t> rows;
    for (const auto& list : mesh_.cells) {
      if (list.type != type) continue;
      for (const auto id : list.global_ids) numbers.push_back(id - cells_before);
      for (const auto node : list.nodes) rows.push_back(natural[static_cast<std::size_t>(node)]);
    }
    const NaturalOrder order(mesh_.comm, count, numbers);
    const auto slice = order.to_slices<std::int64_t>(rows, width);
    file_.write<std::int64_t>(run_layout::cells(type), {count, node_count(type)}, rows_of(order), slice);
    if (mixed) {
      std::vector<std::int64_t> coded;
      for (std::size_t first = 0; first < slice.size(); first += width) {
        coded.push_back(run_layout::xdmf_code(type));
        const auto row = std::span(slice).subspan(first, width);
        coded.insert(coded.end(), row.begin(), row.end());
      }
      const GlobalIndex coded_width = 1 + node_count(type);
      file_.overwrite<std::int64_t>(
          run_layout::mixed, {mixed_length(blocks_), 1},
          {values_before + order.first() * coded_width, static_cast<GlobalIndex>(coded.size())}, coded);
      values_before += count * coded_width;
    }
    cells_before += count;
  }
}

void FrameWriter::write_ranks(bool anew) {
  if (!fields_.rank) return;
  const std::vector<std::int32_t> mine(cells_.item_count(), rank_of(mesh_.comm));
  const auto slice = cells_.to_slices<std::int32_t>(mine);
  if (anew || !file_.contains(run_layout::rank))
    file_.write<std::int32_t>(run_layout::rank, {cells_.total(), 1}, rows_of(cells_), slice);
  else
    file_.overwrite<std::int32_t>(run_layout::rank, {cells_.total(), 1}, rows_of(cells_), slice);
}

void FrameWriter::write_nodes(const std::string& table, const NodeField& field) {
  file_.write<double>(table, {nodes_.total(), 3}, rows_of(nodes_),
                      nodes_.to_slices<double>(field.owned(), 3));
}

template <class T>
void FrameWriter::write_cells(const std::string& table, const std::vector<T>& values) {
  file_.write<T>(table, {cells_.total(), 1}, rows_of(cells_), cells_.template to_slices<T>(values));
}

std::vector<double> FrameWriter::cell_values(const FrameSource::CellValues& of_block,
                                             double otherwise) const {
  std::vector<double> all;
  for (std::size_t block = 0; block < mesh_.cells.size(); ++block) {
    std::vector<double> values(mesh_.cells[block].global_ids.size(), otherwise);
    of_block(block, values);
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

void FrameWriter::write_stretches(const std::string& group, const FrameSource& source) {
  const auto stretches = cell_values(source.min_stretch, 0);
  if (fields_.min_stretch) write_cells(group + "/min_stretch", stretches);
  if (!fields_.inversion) return;
  std::vector<std::uint8_t> inverted;
  for (const auto stretch : stretches) inverted.push_back(stretch < 0 ? 1 : 0);
  write_cells(group + "/inverted", inverted);
}

std::int64_t FrameWriter::frame_bytes() const {
  return mesh_.total_nodes * (fields_.velocity ? 48 : 24) +
         mesh_.total_cells * ((fields_.min_stretch ? 8 : 0) + (fields_.inversion ? 1 : 0) +
                              (fields_.plastic_strain ? 8 : 0) + (fields_.plastic_volume ? 8 : 0)) +
         obstacles_.bytes();
}

void FrameWriter::write(const FrameSource& source) {
  const PhaseScope phase(Phase::io);
  reserve(frame_bytes());
  const auto group = run_layout::frame(frames_.size());
  file_.create_group(group);
  file_.set_attribute(group, "time", source.time);
  file_.set_attribute(group, "step", source.step);
  write_nodes(group + "/positions", source.positions);
  if (fields_.velocity) write_nodes(group + "/velocity", source.velocities);
  if (fields_.min_stretch || fields_.inversion) write_stretches(group, source);
  if (fields_.plastic_strain) write_cells(group + "/plastic_strain", cell_values(source.plastic_strain, 0));
  if (fields_.plastic_volume) write_cells(group + "/plastic_volume", cell_values(source.plastic_volume, 1));
  auto obstacles = obstacles_.write(file_, group);
  file_.flush();
  frames_.push_back({group, source.time, fields_, std::move(obstacles)});
  write_xdmf();
}

void FrameWriter::write_xdmf() const {
  on_root(mesh_.comm, [&] {
    const auto name = std::filesystem::path(file_.path()).filename().string();
    write_file(xdmf_path(), xdmf_text({name, mesh_.total_nodes, blocks_}, frames_));
  });
}

}  // namespace evert
