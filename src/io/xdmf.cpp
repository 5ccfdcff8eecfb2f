#include "xdmf.hpp"

#include "number_text.hpp"
#include "run_layout.hpp"
#include <ostream>
#include <sstream>
#include <string_view>

namespace evert {
namespace {

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  return result;
}

std::string_view topology_name(CellType type) {
  switch (type) {
    case CellType::tet4:
      return "Tetrahedron";
    case CellType::hex8:
      return "Hexahedron";
    case CellType::wedge6:
      return "Wedge";
    case CellType::tet10:
      return "Tetrahedron_10";
  }
  return "";
}

/// A table of the run file as XDMF wants it described.
struct Table {
  std::string path;
  GlobalIndex rows;
  int width;
  std::string_view number;
  int bytes;
};

/// Adds elements line by line.
class Writer {
 public:
  Writer(std::ostream& out, const XdmfRun& run)
      : out_(out), file_(escaped(run.hdf5_name)), nodes_(run.nodes), blocks_(run.blocks) {
    for (const auto& [type, count] : run.blocks) cells_ += count;
  }

  void frame(const WrittenFrame& frame) {
    if (frame.obstacles.empty()) {
      bodies(frame, frame.group, true);
      return;
    }
    out_ << "      <Grid Name=\"" << frame.group
         << "\" GridType=\"Collection\" CollectionType=\"Spatial\">\n";
    time(frame);
    bodies(frame, "bodies", false);
    for (const auto& shown : frame.obstacles) obstacle(shown);
    out_ << "      </Grid>\n";
  }

 private:
  void time(const WrittenFrame& frame) {
    out_ << "        <Time Value=\"" << shortest(frame.time) << "\"/>\n";
  }

  void bodies(const WrittenFrame& frame, std::string_view name, bool timed) {
    out_ << "      <Grid Name=\"" << name << "\" GridType=\"Uniform\">\n";
    if (timed) time(frame);
    topology();
    places(frame.group + "/positions", nodes_);
    if (frame.fields.velocity)
      attribute("velocity", "Vector", "Node", {frame.group + "/velocity", nodes_, 3, "Float", 8});
    if (frame.fields.min_stretch) of_cells("min_stretch", frame.group + "/min_stretch", "Float", 8);
    if (frame.fields.inversion) of_cells("inverted", frame.group + "/inverted", "UChar", 1);
    if (frame.fields.plastic_strain) of_cells("plastic_strain", frame.group + "/plastic_strain", "Float", 8);
    if (frame.fields.plastic_volume) of_cells("plastic_volume", frame.group + "/plastic_volume", "Float", 8);
    of_cells("region", run_layout::region, "Int", 4);
    if (frame.fields.rank) of_cells("rank", run_layout::rank, "Int", 4);
    out_ << "      </Grid>\n";
  }

  void obstacle(const WrittenObstacle& obstacle) {
    out_ << "      <Grid Name=\"" << escaped(obstacle.name) << "\" GridType=\"Uniform\">\n"
         << "        <Topology TopologyType=\"Triangle\" NumberOfElements=\"" << obstacle.triangle_count
         << "\">\n";
    item({run_layout::triangles_of(obstacle.name), obstacle.triangle_count, 3, "Int", 8});
    out_ << "        </Topology>\n";
    places(obstacle.points, obstacle.point_count);
    out_ << "      </Grid>\n";
  }

  void places(const std::string& path, GlobalIndex count) {
    out_ << "        <Geometry GeometryType=\"XYZ\">\n";
    item({path, count, 3, "Float", 8});
    out_ << "        </Geometry>\n";
  }

  void topology() {
    const bool mixed = blocks_.size() > 1;
    const auto type = blocks_.front().first;
    out_ << "        <Topology TopologyType=\"" << (mixed ? "Mixed" : topology_name(type))
         << "\" NumberOfElements=\"" << cells_ << "\">\n";
    if (mixed)
      item({run_layout::mixed, mixed_length(blocks_), 1, "Int", 8});
    else
      item({run_layout::cells(type), cells_, node_count(type), "Int", 8});
    out_ << "        </Topology>\n";
  }

  void of_cells(std::string_view name, const std::string& path, std::string_view number, int bytes) {
    attribute(name, "Scalar", "Cell", {path, cells_, 1, number, bytes});
  }

  void attribute(std::string_view name, std::string_view kind, std::string_view center, const Table& table) {
    out_ << "        <Attribute Name=\"" << name << "\" AttributeType=\"" << kind << "\" Center=\"" << center
         << "\">\n";
    item(table);
    out_ << "        </Attribute>\n";
  }

  void item(const Table& table) {
    out_ << "          <DataItem Dimensions=\"" << table.rows;
    if (table.width > 1) out_ << ' ' << table.width;
    out_ << "\" NumberType=\"" << table.number << "\" Precision=\"" << table.bytes << "\" Format=\"HDF\">"
         << file_ << ':' << table.path << "</DataItem>\n";
  }

  std::ostream& out_;
  std::string file_;
  GlobalIndex nodes_;
  GlobalIndex cells_ = 0;
  const std::vector<std::pair<CellType, GlobalIndex>>& blocks_;
};

}  // namespace

GlobalIndex mixed_length(std::span<const std::pair<CellType, GlobalIndex>> blocks) {
  GlobalIndex length = 0;
  for (const auto& [type, count] : blocks) length += count * (1 + node_count(type));
  return length;
}

std::string xdmf_text(const XdmfRun& run, std::span<const WrittenFrame> frames) {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
      << "    <Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  Writer writer(out, run);
  for (const auto& frame : frames) writer.frame(frame);
  out << "    </Grid>\n  </Domain>\n</Xdmf>\n";
  return std::move(out).str();
}

}  // namespace evert
