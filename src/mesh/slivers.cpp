#include "slivers.hpp"

#include "evert/mesh/cell_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <optional>
#include <span>
#include <utility>

namespace evert {
namespace {

using Tet = std::array<GlobalIndex, 4>;

/// The edge a c and, around it in order, the corners b p d q of the four tetrahedra.
struct Octahedron {
  GlobalIndex a, c;
  std::array<GlobalIndex, 4> ring;
};

/// Tetrahedra of a mesh as they are changed one by one.
class SliverMaker {
 public:
  SliverMaker(Mesh& mesh, const SliverRange& range)
      : mesh_(mesh), tets_(mesh.cells.front()), range_(range), taken_(tets_.region.size()) {}

  /// `cells`: the four around an edge. False, and nothing changes, where no sliver can be made.
  bool make_at(GlobalIndex a, GlobalIndex c, std::span<const std::size_t> cells) {
    if (std::ranges::any_of(cells, [&](std::size_t cell) { return taken_[cell]; })) return false;
    const auto ring = ring_around(a, c, cells);
    if (!ring) return false;
    const auto five = divided({a, c, *ring}, cells);
    if (!five) return false;
    for (std::size_t k = 0; k < 4; ++k) {
      std::copy((*five)[k].begin(), (*five)[k].end(), &tets_.nodes[4 * cells[k]]);
      taken_[cells[k]] = true;
    }
    tets_.nodes.insert(tets_.nodes.end(), (*five)[4].begin(), (*five)[4].end());
    tets_.region.push_back(tets_.region[cells[0]]);
    return true;
  }

 private:
  [[nodiscard]] const Vec3d& at(GlobalIndex node) const {
    return mesh_.nodes[static_cast<std::size_t>(node)];
  }
  [[nodiscard]] double volume(const Tet& tet) const {
    const Vec3d& o = at(tet[0]);
    return dot(at(tet[1]) - o, cross(at(tet[2]) - o, at(tet[3]) - o)) / 6;
  }
  [[nodiscard]] Tet tet(std::size_t cell) const {
    Tet nodes{};
    std::copy_n(&tets_.nodes[4 * cell], 4, nodes.begin());
    return nodes;
  }

  /// The other corners of the cells in order around the edge; nothing where they do not close, at the
  /// surface.
  [[nodiscard]] std::optional<std::array<GlobalIndex, 4>> ring_around(
      GlobalIndex a, GlobalIndex c, std::span<const std::size_t> cells) const {
    std::array<std::array<GlobalIndex, 2>, 4> sides{};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto nodes = tet(cells[k]);
      std::ranges::copy_if(nodes, sides[k].begin(), [&](GlobalIndex node) { return node != a && node != c; });
    }
    std::array<GlobalIndex, 4> ring{sides[0][0], sides[0][1]};
    std::array<bool, 4> used{true};
    for (std::size_t length = 2; length <= 4; ++length) {
      const GlobalIndex last = ring[length - 1];
      std::size_t next = 1;
      while (next < 4 && (used[next] || (sides[next][0] != last && sides[next][1] != last))) ++next;
      if (next == 4) return {};
      used[next] = true;
      const GlobalIndex node = sides[next][0] == last ? sides[next][1] : sides[next][0];
      if (length < 4)
        ring[length] = node;
      else if (node != ring[0])
        return {};
    }
    return ring;
  }

  /// Of the octahedron, five tetrahedra of positive volume, the sliver last; of the four ways to take it
  /// apart the first that is possible.
  [[nodiscard]] std::optional<std::array<Tet, 5>> divided(const Octahedron& o,
                                                          std::span<const std::size_t> cells) const {
    double whole = 0;
    for (const std::size_t cell : cells) whole += volume(tet(cell));
    for (std::size_t turn = 0; turn < 4; ++turn) {
      const GlobalIndex b = o.ring[turn], p = o.ring[(turn + 1) % 4], d = o.ring[(turn + 2) % 4],
                        q = o.ring[(turn + 3) % 4];
      if (!is_thin_enough(o.a, o.c, b, d)) continue;
      std::array<Tet, 5> five{
          {{o.a, b, o.c, q}, {o.a, o.c, d, q}, {o.a, b, d, p}, {b, o.c, d, p}, {o.a, b, o.c, d}}};
      double sum = 0, least = whole;
      for (std::size_t k = 0; k < 5; ++k) {
        auto& part = five[k];
        if (volume(part) < 0) std::swap(part[0], part[1]);
        sum += volume(part);
        if (k < 4) least = std::min(least, volume(part));
      }
      // Sums agree only where none overlap: where the edge b d is on the side of p.
      constexpr double rounding = 1e-10, least_share = 0.1;
      if (sum <= (1 + rounding) * whole && least >= least_share * whole) return five;
    }
    return {};
  }

  [[nodiscard]] bool is_thin_enough(GlobalIndex a, GlobalIndex c, GlobalIndex b, GlobalIndex d) const {
    const Vec3d one = at(c) - at(a), other = at(d) - at(b);
    const Vec3d across = cross(one, other);
    const double distance = std::abs(dot(across, at(b) - at(a))) / norm(across);
    const double thickness = distance / std::max(norm(one), norm(other));
    return thickness >= range_.thinnest && thickness <= range_.thickest;
  }

  Mesh& mesh_;
  CellBlock& tets_;
  SliverRange range_;
  std::vector<bool> taken_;  // cells that a sliver has changed
};

struct EdgeOfCell {
  std::array<GlobalIndex, 2> nodes;  // the lower first
  std::size_t cell;
  auto operator<=>(const EdgeOfCell&) const = default;
};

std::vector<EdgeOfCell> edges_of(const CellBlock& tets) {
  std::vector<EdgeOfCell> edges;
  edges.reserve(6 * tets.region.size());
  for (std::size_t c = 0; c < tets.region.size(); ++c)
    for (const auto& [i, j] : edges_of_tet) {
      const auto [low, high] = std::minmax(tets.nodes[4 * c + i], tets.nodes[4 * c + j]);
      edges.push_back({{low, high}, c});
    }
  std::ranges::sort(edges);
  return edges;
}

}  // namespace

void shake_inner_nodes(Mesh& mesh, double amount, RandomNumbers& random) {
  const auto& tets = mesh.cells.front();
  std::vector<std::vector<std::size_t>> cells_of(mesh.nodes.size());
  for (std::size_t k = 0; k < tets.nodes.size(); ++k)
    cells_of[static_cast<std::size_t>(tets.nodes[k])].push_back(k / 4);
  for (const auto& set : mesh.node_sets)
    if (set.name == "surface")
      for (const auto node : set.nodes) cells_of[static_cast<std::size_t>(node)].clear();
  const auto volume = [&](std::size_t cell) {
    std::array<Vec3d, 4> corners;
    for (std::size_t a = 0; a < 4; ++a)
      corners[a] = mesh.nodes[static_cast<std::size_t>(tets.nodes[4 * cell + a])];
    return cell_volume(CellType::tet4, corners);
  };
  constexpr int attempts = 4;
  constexpr double kept = 0.5;
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
    const auto& cells = cells_of[node];
    if (cells.empty()) continue;
    Vec3d shift{};
    for (double& component : shift.components) component = random.between(-amount, amount);
    std::vector<double> before;
    for (const std::size_t cell : cells) before.push_back(volume(cell));
    const Vec3d at_first = mesh.nodes[node];
    const auto is_sound = [&] {
      for (std::size_t k = 0; k < cells.size(); ++k)
        if (volume(cells[k]) < kept * before[k]) return false;
      return true;
    };
    for (int attempt = 0; attempt < attempts; ++attempt, shift = 0.5 * shift) {
      mesh.nodes[node] = at_first + shift;
      if (is_sound()) break;
      mesh.nodes[node] = at_first;
    }
  }
}

GlobalIndex insert_slivers(Mesh& mesh, GlobalIndex count, const SliverRange& range, RandomNumbers& random) {
  const auto edges = edges_of(mesh.cells.front());
  std::vector<std::size_t> candidates;  // where four of the same edge begin
  for (std::size_t first = 0, next = 0; first < edges.size(); first = next) {
    while (next < edges.size() && edges[next].nodes == edges[first].nodes) ++next;
    if (next - first == 4) candidates.push_back(first);
  }
  SliverMaker maker(mesh, range);
  GlobalIndex made = 0;
  for (std::size_t left = candidates.size(); left > 0 && made < count; --left) {
    std::swap(candidates[random.below(left)], candidates[left - 1]);
    const std::size_t first = candidates[left - 1];
    std::array<std::size_t, 4> cells{};
    for (std::size_t k = 0; k < 4; ++k) cells[k] = edges[first + k].cell;
    const auto [a, c] = edges[first].nodes;
    if (maker.make_at(a, c, cells)) ++made;
  }
  return made;
}

}  // namespace evert
