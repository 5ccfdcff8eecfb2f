#include "plane_cut.hpp"

#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/mesh/cell_geometry.hpp"
#include "evert/mesh/repair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

namespace evert {
namespace {

enum class Side : std::size_t { lower, upper };
constexpr std::array both_sides{Side::lower, Side::upper};

/// Of a tetrahedron, what is strictly on one side, strictly on the other, and on the plane.
struct Parts {
  std::vector<GlobalIndex> own, other, on_plane;
};

class PlaneCut {
 public:
  PlaneCut(Mesh& mesh, const CutPlane& plane) : mesh_(mesh), order_(mesh.nodes) {
    for (auto& node : mesh_.nodes) {
      const double height = dot(plane.normal, node - plane.through);
      const bool moves = std::abs(height) < plane.snap;
      if (moves) node -= height * plane.normal;
      heights_.push_back(moves ? 0 : height);
    }
    parents_.resize(heights_.size());
  }

  void apply() {
    CellBlock& tets = mesh_.cells.front();
    require_upright(tets);
    CellBlock all;
    for (std::size_t c = 0; c < tets.region.size(); ++c) {
      const auto cell = std::span(tets.nodes).subspan(4 * c, 4);
      for (const Side side : both_sides) add(all.nodes, cell, side);
      all.region.resize(all.nodes.size() / 4, tets.region[c]);
    }
    tets = std::move(all);
    reorient(mesh_);
    extend_node_sets();
    drop_unused_nodes(mesh_);
  }

 private:
  [[nodiscard]] double height(GlobalIndex node) const { return heights_[static_cast<std::size_t>(node)]; }
  [[nodiscard]] bool is_on(GlobalIndex node, Side side) const {
    return side == Side::upper ? height(node) > 0 : height(node) < 0;
  }
  [[nodiscard]] bool comes_before(GlobalIndex a, GlobalIndex b) const {
    return order_[static_cast<std::size_t>(a)].components < order_[static_cast<std::size_t>(b)].components;
  }

  /// Those that lie in the plane are dropped, and may be flat.
  void require_upright(const CellBlock& tets) const {
    GlobalIndex turned = 0;
    for_each_cell(mesh_, [&](GlobalIndex, const CellBlock&, std::size_t c, std::span<const Vec3d> corners) {
      const auto cell = std::span(tets.nodes).subspan(4 * c, 4);
      const bool in_plane = std::ranges::all_of(cell, [&](GlobalIndex node) { return height(node) == 0; });
      if (!in_plane && jacobian_range(CellType::tet4, corners).smallest <= flat_jacobian) ++turned;
    });
    if (turned > 0)
      throw UserError(formatted("snap is too large for this plane: it flattens or turns %lld tetrahedra over",
                                static_cast<long long>(turned)));
    for (const Side side : both_sides)
      if (std::ranges::none_of(tets.nodes, [&](GlobalIndex node) { return is_on(node, side); }))
        throw UserError("the plane cuts nothing: everything is on one side of it");
  }

  /// What of the cell is on one side, as tetrahedra in any orientation.
  void add(std::vector<GlobalIndex>& nodes, std::span<const GlobalIndex> cell, Side side) {
    Parts parts;
    for (const GlobalIndex node : cell)
      (height(node) == 0 ? parts.on_plane : is_on(node, side) ? parts.own : parts.other).push_back(node);
    auto& [own, other, on_plane] = parts;
    if (own.empty()) return;
    std::ranges::sort(own, [&](GlobalIndex a, GlobalIndex b) { return comes_before(a, b); });
    for (auto& node : on_plane) node = copy(node, side);
    const auto cut = [&](std::size_t a, std::size_t b) { return crossing(own[a], other[b], side); };
    const auto tet = [&](std::initializer_list<GlobalIndex> corners) {
      nodes.insert(nodes.end(), corners);
      nodes.insert(nodes.end(), on_plane.begin(), on_plane.end());
    };
    if (other.empty()) {
      nodes.insert(nodes.end(), own.begin(), own.end());
      tet({});
    } else if (own.size() == 1) {
      tet({own[0]});
      for (std::size_t b = 0; b < other.size(); ++b) nodes.push_back(cut(0, b));
    } else if (own.size() == 3) {  // a prism; its diagonals start at the earlier corners
      tet({own[0], own[1], own[2], cut(2, 0)});
      tet({own[0], own[1], cut(1, 0), cut(2, 0)});
      tet({own[0], cut(0, 0), cut(1, 0), cut(2, 0)});
    } else if (other.size() == 1) {  // a pyramid over one quadrilateral
      tet({own[0], own[1], cut(1, 0)});
      tet({own[0], cut(0, 0), cut(1, 0)});
    } else {  // a prism, lying; the diagonal of the cut is of no neighbour
      tet({own[0], own[1], cut(1, 0), cut(1, 1)});
      tet({own[0], cut(0, 0), cut(1, 0), cut(1, 1)});
      tet({own[0], cut(0, 0), cut(0, 1), cut(1, 1)});
    }
  }

  /// A node on the plane, as that of one side: the upper one gets a node of its own.
  GlobalIndex copy(GlobalIndex node, Side side) {
    if (side == Side::lower) {
      lower_cut_.push_back(node);
      return node;
    }
    const auto [entry, is_new] = copies_.try_emplace(node, mesh_.node_count());
    if (is_new) add_node(mesh_.nodes[static_cast<std::size_t>(node)], {node, node}, side);
    return entry->second;
  }

  /// The node where an edge meets the plane, of one side.
  GlobalIndex crossing(GlobalIndex a, GlobalIndex b, Side side) {
    if (comes_before(b, a)) std::swap(a, b);  // so that both sides round alike
    const auto [entry, is_new] =
        crossings_[static_cast<std::size_t>(side)].try_emplace({a, b}, mesh_.node_count());
    if (is_new) {
      const double share = height(a) / (height(a) - height(b));
      const Vec3d& from = mesh_.nodes[static_cast<std::size_t>(a)];
      add_node(from + share * (mesh_.nodes[static_cast<std::size_t>(b)] - from), {a, b}, side);
    }
    return entry->second;
  }

  void add_node(Vec3d position, const std::array<GlobalIndex, 2>& parents, Side side) {
    (side == Side::lower ? lower_cut_ : upper_cut_).push_back(mesh_.node_count());
    mesh_.nodes.push_back(position);
    parents_.push_back(parents);
  }

  void extend_node_sets() {
    for (auto& set : mesh_.node_sets) {
      std::vector<bool> has(mesh_.nodes.size());
      for (const GlobalIndex node : set.nodes) has[static_cast<std::size_t>(node)] = true;
      for (std::size_t node = heights_.size(); node < has.size(); ++node) {
        const auto [a, b] = parents_[node];
        if (!has[static_cast<std::size_t>(a)] || !has[static_cast<std::size_t>(b)]) continue;
        has[node] = true;
        set.nodes.push_back(static_cast<GlobalIndex>(node));
      }
    }
    for (auto* cut : {&lower_cut_, &upper_cut_}) {
      std::ranges::sort(*cut);
      cut->erase(std::unique(cut->begin(), cut->end()), cut->end());
    }
    mesh_.node_sets.push_back({"lower_cut", std::move(lower_cut_)});
    mesh_.node_sets.push_back({"upper_cut", std::move(upper_cut_)});
  }

  Mesh& mesh_;
  std::vector<Vec3d> order_;     // positions before any has moved
  std::vector<double> heights_;  // of the first nodes over the plane [m]; 0 on it
  std::vector<std::array<GlobalIndex, 2>>
      parents_;  // of the nodes behind them: what they lie between or upon
  std::map<GlobalIndex, GlobalIndex> copies_;
  std::array<std::map<std::array<GlobalIndex, 2>, GlobalIndex>, 2> crossings_;
  std::vector<GlobalIndex> lower_cut_, upper_cut_;
};

}  // namespace

void cut_along(Mesh& mesh, const CutPlane& plane) { PlaneCut(mesh, plane).apply(); }

}  // namespace evert
