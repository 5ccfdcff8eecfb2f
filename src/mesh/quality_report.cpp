#include "evert/mesh/quality.hpp"

#include "number_text.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ostream>

namespace evert {
namespace {

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

std::string percent(GlobalIndex part, GlobalIndex whole) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%6.2f %%",
                100.0 * static_cast<double>(part) / static_cast<double>(whole));
  return text.data();
}

std::string text_of(const Spread& spread) {
  return rounded(spread.smallest) + " to " + rounded(spread.largest) + ", mean " + rounded(spread.mean);
}

void write_histogram(const MeshQuality& quality, std::ostream& out) {
  const auto& bins = quality.angle_histogram;
  GlobalIndex all = 0;
  for (const auto count : bins) all += count;
  const auto most = *std::ranges::max_element(bins);
  for (std::size_t bin = 0; bin < bins.size(); ++bin) {
    constexpr GlobalIndex width = 40;
    if (bins[bin] == 0) continue;
    std::array<char, 32> range{};
    std::snprintf(range.data(), range.size(), "  %3zu-%3zu ", 10 * bin, 10 * (bin + 1));
    const auto length = std::max<GlobalIndex>(1, bins[bin] * width / most);
    out << range.data() << percent(bins[bin], all) << "  "
        << std::string(static_cast<std::size_t>(length), '#') << '\n';
  }
}

void write_faults(const MeshQuality& quality, std::ostream& out) {
  const auto negative = quality.negative_cells;
  const auto flat = quality.flat_cells;
  out << "negative cells    " << negative
      << (negative > 0 ? "  (evert mesh convert -reorient mends them)" : "") << '\n'
      << "flat cells        " << flat << (flat > 0 ? "  (cannot be simulated)" : "") << '\n';
  if (!quality.first_faulty.empty()) {
    out << "  first of them  ";
    for (const auto cell : quality.first_faulty) out << ' ' << cell;
    out << "  (counted from 0)\n";
  }
  out << "unused nodes      " << quality.unused_nodes
      << (quality.unused_nodes > 0 ? "  (evert mesh convert -drop_unused removes them)" : "") << '\n'
      << "duplicate nodes   " << quality.duplicate_nodes << '\n';
}

/// A JSON string: names come from files and may hold anything.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\u%04x",
                    static_cast<unsigned>(static_cast<unsigned char>(c)));
      result += escape.data();
    } else {
      result += c;
    }
  }
  return result + "\"";
}

/// JSON knows no infinity.
std::string number(double value) { return std::isfinite(value) ? shortest(value) : "null"; }

std::string json_of(const Spread& spread) {
  return "{\"smallest\": " + number(spread.smallest) + ", \"largest\": " + number(spread.largest) +
         ", \"mean\": " + number(spread.mean) + "}";
}

std::string json_of(const Vec3d& point) {
  return "[" + number(point[0]) + ", " + number(point[1]) + ", " + number(point[2]) + "]";
}

template <class Range>
std::string json_list(const Range& range) {
  std::string text;
  for (const auto value : range) text += (text.empty() ? "" : ", ") + shortest(value);
  return "[" + text + "]";
}

std::string json_of(const std::vector<GroupSize>& groups, const char* unit, bool with_volume) {
  std::string text;
  for (const auto& group : groups) {
    text += (text.empty() ? "" : ", ") + ("{\"name\": " + quoted(group.name)) + ", \"" + unit +
            "\": " + std::to_string(group.size);
    if (with_volume) text += ", \"volume\": " + number(group.volume);
    text += "}";
  }
  return "[" + text + "]";
}

}  // namespace

void write_quality_text(const MeshQuality& quality, std::ostream& out) {
  out << "nodes             " << quality.nodes << '\n' << "cells             " << quality.cells << " (";
  bool first = true;
  for (const auto type : all_cell_types) {
    const auto count = quality.cells_of_type[static_cast<std::size_t>(type)];
    if (count == 0) continue;
    out << (first ? "" : ", ") << count << ' ' << name_of(type);
    first = false;
  }
  out << ")\n";
  for (const auto& region : quality.regions)
    out << "  region '" << region.name << "'  " << region.size << " cells, " << rounded(region.volume)
        << " m^3\n";
  for (const auto& set : quality.node_sets)
    out << "  node set '" << set.name << "'  " << set.size << " nodes\n";
  out << "boundary faces    " << quality.boundary_faces << '\n'
      << "components        " << quality.components << '\n'
      << "box               ";
  for (std::size_t axis = 0; axis < 3; ++axis)
    out << (axis > 0 ? " x " : "") << '[' << rounded(quality.lower[axis]) << ", "
        << rounded(quality.upper[axis]) << ']';
  out << " m\n"
      << "volume            " << rounded(quality.total_volume) << " m^3; cells " << text_of(quality.volume)
      << '\n'
      << "edges             " << rounded(quality.edges.shortest) << " to " << rounded(quality.edges.longest)
      << " m\n"
      << "aspect ratio      " << text_of(quality.aspect_ratio) << "  (1 is best)\n";
  write_faults(quality, out);
  out << "dihedral angles   " << text_of(quality.dihedral_angle) << " degrees\n";
  write_histogram(quality, out);
}

void write_quality_json(const MeshQuality& quality, std::ostream& out) {
  out << "{\n  \"nodes\": " << quality.nodes << ",\n  \"cells\": " << quality.cells
      << ",\n  \"cells_of_type\": {";
  for (const auto type : all_cell_types)
    out << (type == all_cell_types.front() ? "" : ", ") << '"' << name_of(type)
        << "\": " << quality.cells_of_type[static_cast<std::size_t>(type)];
  out << "},\n  \"regions\": " << json_of(quality.regions, "cells", true)
      << ",\n  \"node_sets\": " << json_of(quality.node_sets, "nodes", false)
      << ",\n  \"boundary_faces\": " << quality.boundary_faces
      << ",\n  \"components\": " << quality.components << ",\n  \"lower\": " << json_of(quality.lower)
      << ",\n  \"upper\": " << json_of(quality.upper)
      << ",\n  \"total_volume\": " << number(quality.total_volume)
      << ",\n  \"volume\": " << json_of(quality.volume)
      << ",\n  \"shortest_edge\": " << number(quality.edges.shortest)
      << ",\n  \"longest_edge\": " << number(quality.edges.longest)
      << ",\n  \"aspect_ratio\": " << json_of(quality.aspect_ratio)
      << ",\n  \"dihedral_angle\": " << json_of(quality.dihedral_angle)
      << ",\n  \"angle_histogram_by_10_degrees\": " << json_list(quality.angle_histogram)
      << ",\n  \"negative_cells\": " << quality.negative_cells
      << ",\n  \"flat_cells\": " << quality.flat_cells
      << ",\n  \"first_faulty\": " << json_list(quality.first_faulty)
      << ",\n  \"unused_nodes\": " << quality.unused_nodes
      << ",\n  \"duplicate_nodes\": " << quality.duplicate_nodes << "\n}\n";
}

}  // namespace evert
