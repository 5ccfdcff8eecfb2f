#include "evert/io/export.hpp"

#include "evert/io/files.hpp"
#include "evert/io/surface.hpp"
#include "evert/mesh/mesh_writer.hpp"

#include <bit>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace evert {
namespace {

/// The bytes of a binary PLY file: a header, then numbers of this machine's order.
class PlyBytes {
 public:
  explicit PlyBytes(std::string header) : bytes_(std::move(header)) {}
  template <class Number>
  void add(Number value) {
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(&bytes_[at], &value, sizeof value);
  }
  void add(const Vec3d& vector) {
    for (const auto component : vector.components) add(component);
  }
  [[nodiscard]] const std::string& get() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string ply_header(const Surface& surface, bool with_velocity, bool with_stretch) {
  std::string text = "ply\nformat ";
  text += std::endian::native == std::endian::little ? "binary_little_endian" : "binary_big_endian";
  text += " 1.0\nelement vertex " + std::to_string(surface.nodes.size()) + '\n';
  const auto properties = [&](std::initializer_list<std::string_view> names) {
    for (const auto name : names) ((text += "property double ") += name) += '\n';
  };
  properties({"x", "y", "z"});
  if (with_velocity) properties({"velocity_x", "velocity_y", "velocity_z"});
  if (with_stretch) properties({"min_stretch"});
  text += "element face " + std::to_string(surface.triangles.size()) + '\n';
  return text + "property list uchar uint vertex_indices\nend_header\n";
}

}  // namespace

void export_vtu(const RunReader& run, std::size_t frame, const std::filesystem::path& path) {
  Mesh mesh = run.mesh();
  mesh.nodes = run.positions(frame);
  std::vector<CellField> cell_fields;
  if (run.has(frame, "min_stretch")) cell_fields.push_back({"min_stretch", run.min_stretch(frame)});
  for (const char* field : {"plastic_strain", "plastic_volume"})
    if (run.has(frame, field)) cell_fields.push_back({field, run.cell_field(frame, field)});
  if (run.has(frame, "inverted")) {
    const auto flags = run.inverted(frame);
    cell_fields.push_back({"inverted", std::vector<std::int32_t>(flags.begin(), flags.end())});
  }
  if (run.has_ranks()) cell_fields.push_back({"rank", run.ranks()});
  std::vector<NodeVectors> node_vectors;
  if (run.has(frame, "velocity")) node_vectors.push_back({"velocity", run.velocities(frame)});
  write_mesh(mesh, path, MeshFormat::vtu, cell_fields, node_vectors);
}

void export_surface_ply(const RunReader& run, std::size_t frame, const std::filesystem::path& path) {
  const Surface surface = surface_of(run.mesh());
  const auto positions = run.positions(frame);
  std::optional<std::vector<Vec3d>> velocities;
  if (run.has(frame, "velocity")) velocities = run.velocities(frame);
  std::optional<std::vector<double>> stretches;
  if (run.has(frame, "min_stretch")) stretches = smallest_at_vertices(surface, run.min_stretch(frame));

  PlyBytes bytes(ply_header(surface, velocities.has_value(), stretches.has_value()));
  for (std::size_t vertex = 0; vertex < surface.nodes.size(); ++vertex) {
    const auto node = static_cast<std::size_t>(surface.nodes[vertex]);
    bytes.add(positions[node]);
    if (velocities) bytes.add((*velocities)[node]);
    if (stretches) bytes.add((*stretches)[vertex]);
  }
  for (const auto& triangle : surface.triangles) {
    bytes.add(static_cast<std::uint8_t>(triangle.size()));
    for (const auto vertex : triangle) bytes.add(vertex);
  }
  write_file(path.string(), bytes.get());
}

}  // namespace evert
