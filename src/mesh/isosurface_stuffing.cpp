#include "evert/core/positive.hpp"
#include "evert/mesh/boundary.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/repair.hpp"

#include "bcc_lattice.hpp"
#include "hinges.hpp"
#include "mesh_size.hpp"
#include "number_text.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace evert {
namespace {

// A lattice point closer to the surface than these fractions of an edge is moved onto it (Labelle and
// Shewchuk 2007, uniform mesh: the choice with the largest smallest angle).
constexpr double long_edge_fraction = 0.24999;
constexpr double short_edge_fraction = 0.41189;

enum class Side : std::int8_t { outside = -1, surface = 0, inside = 1 };

/// A corner of a tetrahedron of the lattice.
struct Corner {
  LatticePoint point;
  GlobalIndex number;
  Side side;
};

/// Where the surface crosses an edge of the lattice, and the node put there once a tetrahedron needs it.
struct Crossing {
  Vec3d position{};
  GlobalIndex node = -1;
};

using Edge = std::pair<GlobalIndex, GlobalIndex>;

struct EdgeHash {
  std::size_t operator()(const Edge& edge) const {
    return static_cast<std::size_t>(edge.first) * 0x9E3779B97F4A7C15ULL +
           static_cast<std::size_t>(edge.second);
  }
};

LatticePoint step(const LatticePoint& from, const LatticePoint& by) {
  return {from[0] + by[0], from[1] + by[1], from[2] + by[2]};
}

/// A face with the corners a and b inside and c outside is cut to the quadrilateral a, b, crossing(b, c),
/// crossing(a, c). True when it is split from a, false when from b. Both tetrahedra at the face agree, and no
/// element gets an angle below 9 degrees: the diagonal ends on the crossing of the long edge; where the edge
/// a-b is the long one, the two short ones are told apart by the parity rule.
bool is_split_from_first(const Corner& a, const Corner& b, const Corner& c) {
  if (is_long_edge(b.point, c.point)) return true;
  if (is_long_edge(a.point, c.point)) return false;
  int greater = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) greater += c.point[axis] > a.point[axis] ? 1 : 0;
  return greater % 2 == 0;
}

class Stuffing {
 public:
  Stuffing(const ImplicitSurface& shape, std::string name, double edge_length)
      : shape_(shape), name_(std::move(name)), lattice_(lattice_around(shape.bounds(), edge_length)) {}

  Mesh run() {
    classify_points();
    move_points_to_surface();
    lattice_.for_each_tetrahedron([this](const auto& points) { fill(points); });
    if (block_.nodes.empty())
      throw UserError("nothing is inside the " + name_ + " at this edge_length: choose a smaller one");
    leave_out_specks();
    block_.region.assign(block_.nodes.size() / 4, 0);
    mesh_.cells.push_back(std::move(block_));
    mesh_.regions = {"body"};
    drop_unused_nodes(mesh_);  // those of specks
    mesh_.node_sets.push_back({"surface", boundary_nodes(mesh_)});
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] static BccLattice lattice_around(const Box3& box, double edge_length) {
    return {0.5 * (box.lower + box.upper), box.upper - box.lower, edge_length};
  }

  [[nodiscard]] double value_at(const Vec3d& p) const {
    const double value = shape_.signed_distance(p);
    if (std::isnan(value))
      throw UserError("the function of the " + name_ + " gives no number at (" + shortest(p[0]) + ", " +
                      shortest(p[1]) + ", " + shortest(p[2]) + ")");
    return value;
  }

  void classify_points() {
    nodes_.assign(static_cast<std::size_t>(lattice_.point_count()), -1);
    sides_.reserve(nodes_.size());
    lattice_.for_each_point([this](const LatticePoint& point, GlobalIndex /*number*/) {
      const double value = value_at(lattice_.position_of(point));
      sides_.push_back(value < 0 ? Side::inside : value > 0 ? Side::outside : Side::surface);
      if (sides_.back() == Side::inside && lattice_.is_outermost(point))
        throw UserError("the " + name_ + " reaches out of the box given for it");
    });
  }

  void move_points_to_surface() {
    lattice_.for_each_point([this](const LatticePoint& point, GlobalIndex number) {
      const Corner from{point, number, side_of(number)};
      if (from.side == Side::surface) return;
      const auto position = lattice_.position_of(point);
      double nearest = 1;
      for (std::size_t e = 0; e < BccLattice::edges.size(); ++e) {
        const auto end = step(point, BccLattice::edges[e]);
        if (!lattice_.contains(end)) continue;
        const Corner to{end, lattice_.number_of(end), side_of(lattice_.number_of(end))};
        if (to.side == Side::surface || to.side == from.side) continue;
        const auto& crossed = crossing(from, to).position;
        const bool is_long = e < BccLattice::long_edges;
        const double fraction = distance(crossed, position) / lattice_.edge_length(is_long);
        if (fraction >= (is_long ? long_edge_fraction : short_edge_fraction) || fraction >= nearest) continue;
        nearest = fraction;
        moved_[number] = crossed;
        sides_[static_cast<std::size_t>(number)] = Side::surface;
      }
    });
  }

  [[nodiscard]] Side side_of(GlobalIndex number) const { return sides_[static_cast<std::size_t>(number)]; }

  [[nodiscard]] static double distance(const Vec3d& a, const Vec3d& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }

  [[nodiscard]] Crossing& crossing(const Corner& a, const Corner& b) {
    const auto [entry, is_new] = crossings_.try_emplace(Edge{std::minmax(a.number, b.number)});
    if (is_new) {
      const bool a_inside = a.side == Side::inside;
      entry->second.position = find_surface(lattice_.position_of(a_inside ? a.point : b.point),
                                            lattice_.position_of(a_inside ? b.point : a.point));
    }
    return entry->second;
  }

  /// Bisection down to the spacing of numbers: the function may have kinks and any scale.
  [[nodiscard]] Vec3d find_surface(const Vec3d& inside, const Vec3d& outside) const {
    double low = 0;
    double high = 1;
    Vec3d position = inside;
    while (true) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high || high - low < 1e-15) return position;
      position = inside + middle * (outside - inside);
      (value_at(position) < 0 ? low : high) = middle;
    }
  }

  /// Adds the part of a tetrahedron of the lattice that is inside.
  void fill(const std::array<LatticePoint, 4>& points) {
    std::array<Corner, 4> corners{};
    std::array<int, 3> counts{};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto number = lattice_.number_of(points[i]);
      corners[i] = {points[i], number, side_of(number)};
      ++counts[static_cast<std::size_t>(static_cast<int>(corners[i].side) + 1)];
    }
    const auto [outside, surface, inside] = counts;
    if (inside == 0) return;
    const bool mirrored = sort_from_inside(corners);
    if (outside == 0 || inside == 1) return fill_with_one(corners, mirrored);
    if (inside == 3) return fill_three_inside(corners, mirrored);
    if (surface == 1) return fill_two_inside_one_on_surface(corners, mirrored);
    fill_two_inside(corners, mirrored);
  }

  /// Sorts the corners: inside, surface, outside. Returns whether that mirrored the tetrahedron.
  static bool sort_from_inside(std::array<Corner, 4>& corners) {
    bool mirrored = false;
    for (std::size_t end = 3; end > 0; --end)
      for (std::size_t i = 0; i < end; ++i)
        if (corners[i].side < corners[i + 1].side) {
          std::swap(corners[i], corners[i + 1]);
          mirrored = !mirrored;
        }
    return mirrored;
  }

  void fill_with_one(const std::array<Corner, 4>& c, bool mirrored) {
    std::array<GlobalIndex, 4> nodes{};
    for (std::size_t i = 0; i < 4; ++i)
      nodes[i] = c[i].side == Side::outside ? node_between(c[0], c[i]) : node_at(c[i]);
    add_cell(nodes, mirrored);
  }

  /// A pyramid over the quadrilateral face.
  void fill_two_inside_one_on_surface(const std::array<Corner, 4>& c, bool mirrored) {
    auto [a, b, apex, out] = c;
    if (!is_split_from_first(a, b, out)) {
      std::swap(a, b);
      mirrored = !mirrored;
    }
    add_cell({node_at(a), node_at(b), node_at(apex), node_between(b, out)}, mirrored);
    add_cell({node_at(a), node_between(b, out), node_at(apex), node_between(a, out)}, mirrored);
  }

  /// A prism between the triangles at a and at b; the two faces with both inside are split from different
  /// ends.
  void fill_two_inside(const std::array<Corner, 4>& c, bool mirrored) {
    auto [a, b, out, other] = c;
    if (!is_split_from_first(a, b, out)) {
      std::swap(a, b);
      mirrored = !mirrored;
    }
    const auto a_other = node_between(a, other);
    const auto b_out = node_between(b, out);
    add_cell({a_other, node_between(b, other), node_at(b), b_out}, mirrored);
    add_cell({a_other, node_at(a), node_between(a, out), b_out}, mirrored);
    add_cell({a_other, node_at(a), b_out, node_at(b)}, mirrored);
  }

  /// A prism between the three inside and their crossings; the faces along the long edge a-out meet on its
  /// crossing.
  void fill_three_inside(const std::array<Corner, 4>& corners, bool mirrored) {
    auto [a, b, c, out] = corners;
    while (!is_long_edge(a.point, out.point)) {
      std::swap(a, b);
      std::swap(b, c);  // turns the triangle, which mirrors nothing
    }
    if (!is_split_from_first(b, c, out)) {
      std::swap(b, c);
      mirrored = !mirrored;
    }
    const auto a_out = node_between(a, out);
    const auto c_out = node_between(c, out);
    add_cell({a_out, node_at(a), node_at(c), node_at(b)}, mirrored);
    add_cell({a_out, c_out, node_between(b, out), node_at(b)}, mirrored);
    add_cell({a_out, c_out, node_at(b), node_at(c)}, mirrored);
  }

  [[nodiscard]] GlobalIndex node_at(const Corner& corner) {
    auto& node = nodes_[static_cast<std::size_t>(corner.number)];
    if (node < 0) {
      const auto moved = moved_.find(corner.number);
      node = add_node(moved == moved_.end() ? lattice_.position_of(corner.point) : moved->second);
    }
    return node;
  }

  [[nodiscard]] GlobalIndex node_between(const Corner& a, const Corner& b) {
    auto& crossed = crossing(a, b);
    if (crossed.node < 0) crossed.node = add_node(crossed.position);
    return crossed.node;
  }

  /// Parts as thin as the lattice may come out as pieces that hang on an edge or a corner. Specks of such are
  /// left out; without larger ones the body would not be the shape that was asked for.
  void leave_out_specks() {
    constexpr std::size_t speck = 400;  // of so many cells one
    const auto cells = block_.nodes.size() / 4;
    const auto hinged = hinged_pieces(block_.nodes);
    if (hinged.empty()) return;
    if (hinged.front().size() > cells / speck)
      throw UserError("the " + name_ + " has parts too thin for this edge_length: " +
                      std::to_string(hinged.front().size()) + " of " + std::to_string(cells) +
                      " tetrahedra hang on an edge or a corner only; choose a smaller one");
    std::vector<bool> kept(cells, true);
    for (const auto& piece : hinged)
      for (const auto cell : piece) kept[cell] = false;
    std::vector<GlobalIndex> nodes;
    for (std::size_t i = 0; i < block_.nodes.size(); ++i)
      if (kept[i / 4]) nodes.push_back(block_.nodes[i]);
    block_.nodes = std::move(nodes);
  }

  GlobalIndex add_node(const Vec3d& position) {
    mesh_.nodes.push_back(position);
    return mesh_.node_count() - 1;
  }

  void add_cell(std::array<GlobalIndex, 4> nodes, bool mirrored) {
    if (mirrored) std::swap(nodes[2], nodes[3]);
    block_.nodes.insert(block_.nodes.end(), nodes.begin(), nodes.end());
  }

  const ImplicitSurface& shape_;
  std::string name_;  // for messages
  BccLattice lattice_;
  std::vector<Side> sides_;         // per lattice point
  std::vector<GlobalIndex> nodes_;  // per lattice point, −1 until used
  std::unordered_map<GlobalIndex, Vec3d> moved_;
  std::unordered_map<Edge, Crossing, EdgeHash> crossings_;
  Mesh mesh_;
  CellBlock block_;
};

/// Volume of the shape [m³], from the fraction of samples inside: good to a few percent, for estimates.
double roughly_the_volume(const ImplicitSurface& shape, const Box3& box) {
  constexpr int samples = 32;
  const auto size = box.upper - box.lower;
  int inside = 0;
  for (int k = 0; k < samples; ++k)
    for (int j = 0; j < samples; ++j)
      for (int i = 0; i < samples; ++i) {
        const Vec3d p{box.lower[0] + size[0] * (i + 0.5) / samples,
                      box.lower[1] + size[1] * (j + 0.5) / samples,
                      box.lower[2] + size[2] * (k + 0.5) / samples};
        inside += shape.signed_distance(p) < 0 ? 1 : 0;
      }
  return size[0] * size[1] * size[2] * inside / (samples * samples * samples);
}

}  // namespace

Mesh generate(const ImplicitSurface& shape, const std::string& name, double edge_length) {
  require_positive(edge_length, "edge_length");
  const auto box = shape.bounds();
  const auto size = box.upper - box.lower;
  for (const double side : size.components) require_positive(side, "a side of the box of the " + name);
  const double shortest_side = std::min({size[0], size[1], size[2]});
  if (edge_length > shortest_side / 2)
    throw UserError("edge_length is " + shortest(edge_length) + ", but must be at most " +
                    shortest(shortest_side / 2) + ", half the shortest extent of the " + name);
  const double cube = edge_length * edge_length * edge_length;
  require_possible_size(12 * roughly_the_volume(shape, box) / cube, 2 * size[0] * size[1] * size[2] / cube);
  return Stuffing(shape, name, edge_length).run();
}

}  // namespace evert
