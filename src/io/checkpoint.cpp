#include "evert/io/checkpoint.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/log.hpp"
#include "evert/io/files.hpp"
#include "evert/io/hdf5_file.hpp"

#include "digest.hpp"
#include "tables.hpp"
#include <bit>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace evert {
namespace {

const std::string format = "evert checkpoint";
constexpr std::int64_t format_version = 2;

// Attributes hold signed integers.
std::int64_t as_attribute(std::uint64_t digest) { return std::bit_cast<std::int64_t>(digest); }

/// What can be said of a file without HDF5.
void require_hdf5(const std::string& path) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  if (!std::filesystem::exists(path)) throw UserError("there is no checkpoint '" + path + "'");
  if (!std::filesystem::is_regular_file(path)) throw UserError("checkpoint '" + path + "' is not a file");
  std::string begin(signature.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(file.gcount()));
  if (begin.size() < signature.size() && signature.starts_with(begin))
    throw UserError("checkpoint '" + path + "' is truncated");
  if (begin != signature) throw UserError("'" + path + "' is not a checkpoint of evert");
}

void require_format(const Hdf5File& file) {
  std::string found;
  try {
    found = file.attribute<std::string>("/", "format");
  } catch (const UserError&) {
    found.clear();
  }
  if (found != format) throw UserError("'" + file.path() + "' is not a checkpoint of evert");
  const auto version = file.attribute<std::int64_t>("/", "format_version");
  if (version != format_version)
    throw UserError("checkpoint '" + file.path() + "' has format version " + std::to_string(version) +
                    ", this evert reads version " + std::to_string(format_version));
}

/// Throws UserError unless the file is a whole checkpoint of this scene and mesh. Called on one rank.
void require_usable(const std::string& path, const std::string& fingerprint, GlobalIndex nodes,
                    std::uint64_t mesh_digest) {
  require_hdf5(path);
  try {
    const auto file = Hdf5File::open(MPI_COMM_SELF, path, Hdf5File::Access::read);
    require_format(file);
    if (file.attribute<std::string>("/", "fingerprint") != fingerprint)
      throw UserError("checkpoint '" + path + "' belongs to another scene");
    const auto fits = [&](const std::string& table) { return file.shape_of(table) == TableShape{nodes, 3}; };
    if (!fits("/positions") || !fits("/velocities") || !fits("/velocity_changes") ||
        file.attribute<std::int64_t>("/", "mesh_digest") != as_attribute(mesh_digest))
      throw UserError("checkpoint '" + path + "' belongs to another mesh");
  } catch (const Hdf5Error& error) {
    throw UserError("checkpoint '" + path + "' is truncated or damaged: " + error.reason());
  }
}

/// Numbers in a row of the table of flow, as many as the cells of any entry remember; 0 where none remembers
/// any. The same on every rank.
std::size_t width_of(const DistributedMesh& mesh, const FlowState& flow) {
  std::uint64_t width = 0;
  for (std::size_t e = 0; e < flow.size(); ++e)
    if (!flow[e].empty())
      width = std::max<std::uint64_t>(width, flow[e].size() / mesh.cells[e].global_ids.size());
  MPI_Allreduce(MPI_IN_PLACE, &width, 1, MPI_UINT64_T, MPI_MAX, mesh.comm);
  return width;
}

/// A row for every cell, in the order of `mesh.cells`.
std::vector<double> as_rows(const DistributedMesh& mesh, const FlowState& flow, std::size_t width) {
  std::vector<double> rows;
  for (std::size_t e = 0; e < flow.size(); ++e) {
    const std::size_t cells = mesh.cells[e].global_ids.size();
    const std::size_t own = cells > 0 ? flow[e].size() / cells : 0;
    for (std::size_t c = 0; c < cells; ++c) {
      const auto numbers = std::span(flow[e]).subspan(own * c, own);
      rows.insert(rows.end(), numbers.begin(), numbers.end());
      rows.resize(rows.size() + width - own);
    }
  }
  return rows;
}

/// The rows of each entry, at full width.
FlowState from_rows(const DistributedMesh& mesh, std::span<const double> rows, std::size_t width) {
  FlowState flow;
  for (const auto& cells : mesh.cells) {
    const std::size_t count = width * cells.global_ids.size();
    flow.emplace_back(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(count));
    rows = rows.subspan(count);
  }
  return flow;
}

std::vector<StateScalar> read_scalars(const Hdf5File& file) {
  const auto names = file.attribute<std::vector<std::string>>("/", "scalar_names");
  const auto values = file.attribute<std::vector<double>>("/", "scalar_values");
  if (names.size() != values.size())
    throw UserError("checkpoint '" + file.path() + "' is damaged: a scalar is missing");
  std::vector<StateScalar> scalars;
  for (std::size_t i = 0; i < names.size(); ++i) scalars.emplace_back(names[i], values[i]);
  return scalars;
}

}  // namespace

CheckpointWriter::CheckpointWriter(const DistributedMesh& mesh, std::string path, std::string fingerprint)
    : mesh_(mesh),
      path_(std::move(path)),
      fingerprint_(std::move(fingerprint)),
      mesh_digest_(digest(mesh)),
      order_(natural_node_order(mesh)),
      cells_(natural_cell_order(mesh)) {
  on_root(mesh.comm, [&] { require_writable(path_); });
}

void CheckpointWriter::write(const NodeState& nodes, std::span<const StateScalar> scalars,
                             const FlowState& flow) const {
  const PhaseScope phase(Phase::io);
  const std::string temporary = path_ + ".tmp";
  try {
    on_root(mesh_.comm, [&] { require_writable(temporary); });
    write_file(temporary, nodes, flow, scalars);
    on_every_rank(mesh_.comm, [&] { sync_file(temporary); });
    on_root(mesh_.comm, [&] { replace_file(temporary, path_); });
  } catch (const UserError&) {
    on_root(mesh_.comm, [&] { std::remove(temporary.c_str()); });
    throw;
  }
}

void CheckpointWriter::write_file(const std::string& path, const NodeState& nodes, const FlowState& flow,
                                  std::span<const StateScalar> scalars) const {
  auto file = Hdf5File::create(mesh_.comm, path);
  std::vector<std::string> names;
  std::vector<double> values;
  const std::size_t flow_width = width_of(mesh_, flow);
  auto bytes = mesh_.total_nodes * 72 + mesh_.total_cells * static_cast<std::int64_t>(8 * flow_width) +
               metadata_allowance + static_cast<std::int64_t>(fingerprint_.size());
  for (const auto& [name, value] : scalars) {
    names.push_back(name);
    values.push_back(value);
    bytes += 256;
  }
  on_root(mesh_.comm, [&] { reserve_space(path, bytes); });
  file.set_attribute("/", "format", format);
  file.set_attribute("/", "format_version", format_version);
  file.set_attribute("/", "fingerprint", fingerprint_);
  file.set_attribute("/", "mesh_digest", as_attribute(mesh_digest_));
  file.set_attribute("/", "scalar_names", names);
  file.set_attribute("/", "scalar_values", values);
  const auto write_table = [&](const std::string& table, const NaturalOrder& order, std::size_t width,
                               std::span<const double> owned) {
    const auto slice = order.to_slices<double>(owned, width);
    const auto columns = static_cast<GlobalIndex>(width);
    file.write<double>(table, {order.total(), columns}, rows_of(order), slice);
    file.set_attribute(table, "digest", as_attribute(digest(mesh_.comm, columns * order.first(), slice)));
  };
  write_table("/positions", order_, 3, nodes.positions);
  write_table("/velocities", order_, 3, nodes.velocities);
  write_table("/velocity_changes", order_, 3, nodes.velocity_changes);
  if (flow_width > 0) write_table("/flow", cells_, flow_width, as_rows(mesh_, flow, flow_width));
  file.close();
}

CheckpointState read_checkpoint(const DistributedMesh& mesh, const std::string& path,
                                const std::string& fingerprint) {
  const PhaseScope phase(Phase::io);
  const auto mesh_digest = digest(mesh);
  on_root(mesh.comm, [&] { require_usable(path, fingerprint, mesh.total_nodes, mesh_digest); });
  const auto order = natural_node_order(mesh);
  const auto file = Hdf5File::open(mesh.comm, path, Hdf5File::Access::read);
  const auto read_table = [&](const std::string& table, const NaturalOrder& of_table, std::size_t width) {
    const auto slice = file.read<double>(table, rows_of(of_table));
    if (as_attribute(digest(mesh.comm, static_cast<GlobalIndex>(width) * of_table.first(), slice)) !=
        file.attribute<std::int64_t>(table, "digest"))
      throw UserError("checkpoint '" + path + "' is damaged: the values of '" + table + "' have changed");
    return of_table.to_owners<double>(slice, width);
  };
  CheckpointState state{.positions = read_table("/positions", order, 3),
                        .velocities = read_table("/velocities", order, 3),
                        .velocity_changes = read_table("/velocity_changes", order, 3),
                        .flow = {},
                        .scalars = read_scalars(file)};
  if (file.contains("/flow")) {
    const auto width = static_cast<std::size_t>(file.shape_of("/flow").width);
    state.flow = from_rows(mesh, read_table("/flow", natural_cell_order(mesh), width), width);
  }
  return state;
}

}  // namespace evert
