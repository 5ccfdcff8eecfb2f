#include "evert/mesh/round_bar.hpp"

#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/core/positive.hpp"
#include "evert/mesh/boundary.hpp"

#include "mesh_size.hpp"
#include "split_hexahedra.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace evert {
namespace {

/// Half of the diagonal of the square in the middle, in radii.
constexpr double square_share = 0.55;

struct Point2 {
  double x, y;
};

/// One layer of nodes and of quadrilaterals, counterclockwise seen from where x × y points to.
struct Section {
  std::vector<Point2> nodes;
  std::vector<std::array<int, 4>> cells;
};

/// A square of n² cells, half way to a disk, and the numbers of the nodes along its edge, counterclockwise
/// from the corner at −x −y.
std::vector<int> add_square(Section& section, int n, double half_diagonal) {
  const auto node = [n](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double u = 2.0 * i / n - 1, v = 2.0 * j / n - 1;
      const double of_disk_u = u * std::sqrt(1 - v * v / 2), of_disk_v = v * std::sqrt(1 - u * u / 2);
      const double side = half_diagonal / std::numbers::sqrt2;
      section.nodes.push_back(
          {0.5 * (side * u + half_diagonal * of_disk_u), 0.5 * (side * v + half_diagonal * of_disk_v)});
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      section.cells.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
  std::vector<int> edge;
  for (int i = 0; i < n; ++i) edge.push_back(node(i, 0));
  for (int j = 0; j < n; ++j) edge.push_back(node(n, j));
  for (int i = n; i > 0; --i) edge.push_back(node(i, n));
  for (int j = n; j > 0; --j) edge.push_back(node(0, j));
  return edge;
}

Point2 on_circle(double radius, int quarter, std::size_t m) {
  const double angle = std::numbers::pi * (-0.75 + 0.5 * static_cast<double>(m) / quarter);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Rings from the nodes `inner` to the circle.
void add_rings(Section& section, std::vector<int> inner, const RoundBar& bar) {
  const std::vector<int> first = inner;
  const std::size_t around = first.size();
  for (int ring = 1; ring <= bar.rings; ++ring) {
    std::vector<int> outer;
    const double share = static_cast<double>(ring) / bar.rings;
    for (std::size_t m = 0; m < around; ++m) {
      const Point2 from = section.nodes[static_cast<std::size_t>(first[m])];
      const Point2 to = on_circle(bar.radius, bar.quarter, m);
      outer.push_back(static_cast<int>(section.nodes.size()));
      section.nodes.push_back({from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)});
    }
    for (std::size_t m = 0; m < around; ++m) {
      const std::size_t next = (m + 1) % around;
      section.cells.push_back({inner[m], outer[m], outer[next], inner[next]});
    }
    inner = std::move(outer);
  }
}

Section section_of(const RoundBar& bar) {
  Section section;
  std::vector<int> inner;
  if (bar.inner_radius > 0) {
    for (std::size_t m = 0; m < 4 * static_cast<std::size_t>(bar.quarter); ++m) {
      inner.push_back(static_cast<int>(m));
      section.nodes.push_back(on_circle(bar.inner_radius, bar.quarter, m));
    }
  } else {
    inner = add_square(section, bar.quarter, square_share * bar.radius);
  }
  add_rings(section, std::move(inner), bar);
  return section;
}

void require_possible(const RoundBar& bar) {
  require_positive(bar.radius, "radius");
  require_positive(bar.length, "length");
  if (!(bar.inner_radius >= 0 && bar.inner_radius < bar.radius))
    throw UserError(formatted("inner_radius is %g, but must be from 0 to less than the radius, %g",
                              bar.inner_radius, bar.radius));
  if (bar.quarter < 1 || bar.rings < 1 || bar.layers < 0)
    throw UserError("quarter and rings must be at least 1, layers at least 0");
}

int layers_of(const RoundBar& bar) {
  if (bar.layers > 0) return bar.layers;
  const double width = std::numbers::pi * (bar.radius + bar.inner_radius) / (4.0 * bar.quarter);
  return static_cast<int>(std::max(1.0, std::min(1e9, std::round(bar.length / width))));
}

}  // namespace

Mesh generate_round_bar(const RoundBar& bar) {
  require_possible(bar);
  const int layers = layers_of(bar);
  const double of_layer = (bar.inner_radius > 0 ? 0.0 : static_cast<double>(bar.quarter) * bar.quarter) +
                          4.0 * bar.quarter * bar.rings;
  require_possible_size((bar.cell == RoundBarCells::tet6 ? 6 : 1) * of_layer * layers,
                        of_layer * (layers + 1));
  const Section section = section_of(bar);
  const auto nodes = static_cast<GlobalIndex>(section.nodes.size());
  Mesh mesh{.nodes = {}, .cells = {}, .regions = {"body"}, .node_sets = {}};
  for (int layer = 0; layer <= layers; ++layer)
    for (const auto& [x, z] : section.nodes)  // y grows where z × x points to
      mesh.nodes.push_back({z, bar.length * ((2.0 * layer - layers) / (2.0 * layers)), x});
  CellBlock block{CellType::hex8, {}, {}};
  for (int layer = 0; layer < layers; ++layer)
    for (const auto& cell : section.cells) {
      for (const int above : {0, 1})
        for (const int node : cell) block.nodes.push_back((GlobalIndex{layer} + above) * nodes + node);
      block.region.push_back(0);
    }
  mesh.cells.push_back(bar.cell == RoundBarCells::tet6 ? split_hexahedra(block) : std::move(block));
  NodeSet lower{"y_min", {}}, upper{"y_max", {}};
  for (GlobalIndex node = 0; node < nodes; ++node) {
    lower.nodes.push_back(node);
    upper.nodes.push_back(layers * nodes + node);
  }
  mesh.node_sets.push_back({"surface", boundary_nodes(mesh)});
  mesh.node_sets.push_back(std::move(lower));
  mesh.node_sets.push_back(std::move(upper));
  return mesh;
}

}  // namespace evert
