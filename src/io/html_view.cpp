#include "evert/io/html_view.hpp"

#include "evert/core/error.hpp"
#include "evert/io/json_text.hpp"
#include "evert/io/surface.hpp"

#include "../mesh/base64.hpp"
#include "html_numbers.hpp"
#include "html_obstacles.hpp"
#include "number_text.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace evert {

/// The page without its run; made from view_page.html.
extern const std::string_view view_page;

namespace {

/// What the colours show.
enum class Colouring { none, inverted, min_stretch };

/// One frame: values per vertex of the surface, and where elements are inverted.
struct ShownFrame {
  std::size_t number = 0;  // in the run
  double time = 0;         // [s]
  std::vector<Vec3d> positions{};
  std::vector<double> values{};  // empty without colouring; negative where inverted
  std::vector<Vec3d>
      inverted{};  // centres of inverted cells, inner ones too; no more than there are vertices
  double inverted_fraction = 0;
};

/// `shown` numbers out of 0 … count − 1, evenly spaced.
std::vector<std::size_t> evenly_spaced(std::size_t count, std::size_t shown) {
  std::vector<std::size_t> numbers(shown);
  const double spacing =
      static_cast<double>(count - 1) / static_cast<double>(std::max<std::size_t>(shown - 1, 1));
  for (std::size_t i = 0; i < shown; ++i)
    numbers[i] = static_cast<std::size_t>(std::lround(static_cast<double>(i) * spacing));
  return numbers;
}

/// Bytes of a frame in the page at most, in base64: four numbers of 16 bits a vertex, three an inverted cell.
std::size_t page_bytes_a_frame(const Surface& surface) { return surface.nodes.size() * (8 + 6) * 4 / 3 + 64; }

std::size_t frames_that_fit(const Surface& surface, const ObstacleBytes& obstacles, std::size_t max_bytes) {
  const auto fixed = view_page.size() + surface.triangles.size() * 12 * 4 / 3 + obstacles.fixed;
  const auto each = page_bytes_a_frame(surface) + obstacles.a_frame;
  return max_bytes > fixed ? std::max<std::size_t>((max_bytes - fixed) / each, 1) : 1;
}

Colouring colouring_of(const RunReader& run, std::span<const std::size_t> numbers) {
  const auto all_have = [&](const char* field) {
    return std::ranges::all_of(numbers, [&](std::size_t number) { return run.has(number, field); });
  };
  if (all_have("min_stretch")) return Colouring::min_stretch;
  return all_have("inverted") ? Colouring::inverted : Colouring::none;
}

/// Per cell, negative where inverted.
std::vector<double> cell_values(const RunReader& run, std::size_t number, Colouring colouring) {
  if (colouring == Colouring::min_stretch) return run.min_stretch(number);
  const auto inverted = run.inverted(number);
  std::vector<double> values(inverted.size());
  std::ranges::transform(inverted, values.begin(), [](std::uint8_t flag) { return flag != 0 ? -1.0 : 1.0; });
  return values;
}

/// So that squares and differences of positions stay finite.
constexpr double farthest = 1e100;  // [m]

void require_finite(std::span<const Vec3d> positions, const std::string& where) {
  for (const auto& position : positions)
    for (const double coordinate : position.components)
      if (!(std::abs(coordinate) < farthest))
        throw UserError(where + " has a node at " + shortest(coordinate) + " m, which cannot be shown");
}

/// Centres of the cells with negative values; evenly thinned out to `most`.
std::vector<Vec3d> centres_of_inverted(const Mesh& mesh, std::span<const Vec3d> positions,
                                       std::span<const double> values, std::size_t most) {
  const auto count = static_cast<std::size_t>(std::ranges::count_if(values, [](double v) { return v < 0; }));
  const auto stride = (count + most - 1) / most;
  std::vector<Vec3d> centres;
  std::size_t cell = 0;
  std::size_t met = 0;
  for (const auto& block : mesh.cells) {
    const auto nodes_a_cell = static_cast<std::size_t>(node_count(block.type));
    for (std::size_t first = 0; first < block.nodes.size(); first += nodes_a_cell) {
      if (!(values[cell++] < 0) || met++ % stride != 0) continue;
      Vec3d sum{};
      for (const auto node : std::span(block.nodes).subspan(first, nodes_a_cell))
        sum += positions[static_cast<std::size_t>(node)];
      centres.push_back(sum * (1 / static_cast<double>(nodes_a_cell)));
    }
  }
  return centres;
}

ShownFrame shown_frame(const RunReader& run, const Mesh& mesh, const Surface& surface, std::size_t number,
                       Colouring colouring, std::size_t up) {
  ShownFrame frame{.number = number, .time = run.frames()[number].time};
  const auto name = "frame " + std::to_string(number) + " of '" + run.path() + "'";
  if (!std::isfinite(frame.time)) throw UserError(name + " has no finite time");
  auto positions = run.positions(number);
  require_finite(positions, name);
  for (auto& position : positions) position = upright(position, up);
  for (const auto node : surface.nodes) frame.positions.push_back(positions[static_cast<std::size_t>(node)]);
  if (colouring == Colouring::none) return frame;
  const auto values = cell_values(run, number, colouring);
  frame.values = smallest_at_vertices(surface, values);
  frame.inverted = centres_of_inverted(mesh, positions, values, surface.nodes.size());
  const auto inverted = std::ranges::count_if(values, [](double value) { return value < 0; });
  frame.inverted_fraction = static_cast<double>(inverted) / static_cast<double>(values.size());
  return frame;
}

using Bounds = std::pair<Vec3d, Vec3d>;

Bounds bounds_of(std::span<const ShownFrame> frames) {
  std::vector<Vec3d> corners;
  for (const auto& frame : frames)
    for (const auto& points : {std::span(frame.positions), std::span(frame.inverted)}) {
      if (points.empty()) continue;
      const auto [lower, upper] = bounds_of(points);
      corners.insert(corners.end(), {lower, upper});
    }
  return bounds_of(corners);
}

/// Whether the bodies come down to height 0 and no further: then something holds them there.
bool stands_on_ground(const Bounds& bounds) {
  return std::abs(bounds.first[1]) < 0.02 * norm(bounds.second - bounds.first);
}

// --- numbers as the page reads them: little-endian, in base64

constexpr double steps = 65535;

std::uint16_t quantised(double coordinate, double lower, double upper) {
  if (!(upper > lower)) return 0;
  return static_cast<std::uint16_t>(std::lround(steps * (coordinate - lower) / (upper - lower)));
}

/// [-1, 1] to 1 … 65535 with 32768 for 0; the sign survives rounding, and what is not a number is 0,
/// "unknown".
std::uint16_t quantised_stretch(double stretch) {
  constexpr int middle = 32768;
  const auto rounded = static_cast<int>(std::lround((middle - 1) * std::clamp(stretch, -1.0, 1.0)));
  return static_cast<std::uint16_t>(middle + (stretch < 0 ? std::min(rounded, -1) : rounded));
}

void append(std::string& bytes, const Vec3d& position, const Bounds& bounds) {
  for (std::size_t c = 0; c < 3; ++c)
    append_number(bytes, quantised(position[c], bounds.first[c], bounds.second[c]));
}

/// The vertices and, after blanks, the inverted cells and the points of the obstacles.
std::string frame_text(const ShownFrame& frame, const Bounds& bounds, const std::string& obstacles) {
  std::string vertices;
  vertices.reserve(frame.positions.size() * 8);
  for (std::size_t v = 0; v < frame.positions.size(); ++v) {
    append(vertices, frame.positions[v], bounds);
    append_number(vertices, frame.values.empty() ? std::uint16_t{0} : quantised_stretch(frame.values[v]));
  }
  std::string inverted;
  for (const auto& centre : frame.inverted) append(inverted, centre, bounds);
  return to_base64(vertices) + ' ' + to_base64(inverted) + ' ' + obstacles;
}

std::string triangles_text(const Surface& surface) {
  std::string bytes;
  bytes.reserve(surface.triangles.size() * 12);
  for (const auto& triangle : surface.triangles)
    for (const auto vertex : triangle) append_number(bytes, vertex);
  return to_base64(bytes);
}

// --- the page

JsonValue json(const Vec3d& v) { return JsonValue::list({v[0], v[1], v[2]}); }

std::string_view name_of(Colouring colouring) {
  switch (colouring) {
    case Colouring::none:
      return "none";
    case Colouring::inverted:
      return "inverted";
    case Colouring::min_stretch:
      return "min_stretch";
  }
  return "";
}

/// What the page knows besides the two tables of numbers. A frame is [number, time, inverted fraction].
std::string facts(const RunReader& run, const Surface& surface, std::span<const ShownFrame> frames,
                  const Bounds& bounds, bool ground, Colouring colouring, const ShownObstacles& obstacles) {
  std::vector<JsonValue> list;
  for (const auto& frame : frames)
    list.push_back(JsonValue::list({frame.number, frame.time, frame.inverted_fraction}));
  return JsonValue::object(
             {{"nodes", run.node_count()},
              {"cells", run.cell_count()},
              {"vertices", surface.nodes.size()},
              {"lower", json(bounds.first)},
              {"upper", json(bounds.second)},
              {"ground", ground ? 1 : 0},
              {"colouring", name_of(colouring)},
              {"obstacles", JsonValue::list({obstacles.point_counts.begin(), obstacles.point_counts.end()})},
              {"frames", JsonValue::list(list)}})
      .text();
}

std::string html_escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '>')
      escaped += "&gt;";
    else
      escaped += c;
  }
  return escaped;
}

/// The page with every {{name}} replaced.
std::string filled(std::string_view page, std::span<const std::pair<std::string_view, std::string>> values) {
  std::string text;
  while (true) {
    const auto begin = page.find("{{");
    text += page.substr(0, begin);
    if (begin == std::string_view::npos) return text;
    const auto end = page.find("}}", begin);
    const auto name = page.substr(begin + 2, end - begin - 2);
    const auto value = std::ranges::find(values, name, &std::pair<std::string_view, std::string>::first);
    EVERT_ASSERT(value != values.end(), std::string(name));
    text += value->second;
    page.remove_prefix(end + 2);
  }
}

}  // namespace

HtmlView html_view(const RunReader& run, const HtmlViewOptions& options) {
  if (run.frames().empty()) throw UserError("'" + run.path() + "' has no frames to show");
  const auto mesh = run.mesh();
  require_finite(mesh.nodes, "the mesh of '" + run.path() + "'");
  const auto whole = surface_of(mesh);
  if (whole.triangles.empty()) throw UserError("'" + run.path() + "' has no cells to show");
  const auto surface = simplified(whole, mesh.nodes, options.max_triangles);
  if (surface.triangles.empty())
    throw UserError("nothing of the surface of '" + run.path() + "' is left with at most " +
                    std::to_string(options.max_triangles) + " triangles: it must be more");

  const auto wanted = std::min(run.frames().size(), options.max_frames);
  const auto shown =
      std::min(wanted, frames_that_fit(surface, page_bytes_of_obstacles(run), options.max_bytes));
  const auto numbers = evenly_spaced(run.frames().size(), shown);
  const auto colouring = colouring_of(run, numbers);
  std::vector<ShownFrame> frames;
  for (const auto number : numbers)
    frames.push_back(shown_frame(run, mesh, surface, number, colouring, options.up));

  const auto of_bodies = bounds_of(frames);
  auto obstacles = shown_obstacles(run, numbers, options.up, of_bodies);
  obstacles.corners.insert(obstacles.corners.end(), {of_bodies.first, of_bodies.second});
  const auto bounds = bounds_of(obstacles.corners);
  std::string frame_lines;
  for (std::size_t f = 0; f < frames.size(); ++f)
    frame_lines += frame_text(frames[f], bounds, obstacles.points[f]) + '\n';
  const bool ground = stands_on_ground(of_bodies);
  const std::array<std::pair<std::string_view, std::string>, 5> values{
      {{"title", html_escaped(options.title)},
       {"facts", facts(run, surface, frames, bounds, ground, colouring, obstacles)},
       {"triangles", triangles_text(surface)},
       {"obstacles", obstacles.surfaces},
       {"frames", std::move(frame_lines)}}};
  return {filled(view_page, values), shown, surface.triangles.size(), whole.triangles.size(), shown < wanted};
}

}  // namespace evert
