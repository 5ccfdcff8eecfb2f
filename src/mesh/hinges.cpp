#include "hinges.hpp"

#include "evert/math/disjoint_sets.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

namespace evert {
namespace {

using Face = std::array<GlobalIndex, 3>;

std::array<Face, 4> faces_of(std::span<const GlobalIndex, 4> cell) {
  std::array<GlobalIndex, 4> sorted{};
  std::copy(cell.begin(), cell.end(), sorted.begin());
  std::sort(sorted.begin(), sorted.end());
  const auto [a, b, c, d] = sorted;
  return {{{a, b, c}, {a, b, d}, {a, c, d}, {b, c, d}}};
}

}  // namespace

std::vector<std::vector<std::size_t>> hinged_pieces(std::span<const GlobalIndex> nodes) {
  const auto cells = nodes.size() / 4;
  const auto cell = [&](std::size_t i) { return nodes.subspan(4 * i).first<4>(); };
  std::vector<std::pair<Face, std::size_t>> faces;
  faces.reserve(4 * cells);
  for (std::size_t i = 0; i < cells; ++i)
    for (const auto& face : faces_of(cell(i))) faces.emplace_back(face, i);
  std::sort(faces.begin(), faces.end());
  DisjointSets by_face(cells);
  for (std::size_t k = 1; k < faces.size(); ++k)
    if (faces[k].first == faces[k - 1].first) by_face.join(faces[k].second, faces[k - 1].second);

  // The cell that a node was seen in first: what else has the node belongs to the same body.
  DisjointSets by_node = by_face;
  std::unordered_map<GlobalIndex, std::size_t> seen;
  for (std::size_t i = 0; i < cells; ++i)
    for (const auto node : cell(i)) by_node.join(i, seen.try_emplace(node, i).first->second);

  std::map<std::size_t, std::vector<std::size_t>> members;  // by piece
  for (std::size_t i = 0; i < cells; ++i) members[by_face.root(i)].push_back(i);
  std::vector<std::vector<std::size_t>> pieces;
  for (auto& [piece, its_cells] : members) pieces.push_back(std::move(its_cells));
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  std::set<std::size_t> bodies;  // of which the largest piece has been seen
  std::erase_if(pieces, [&](const auto& piece) { return bodies.insert(by_node.root(piece.front())).second; });
  return pieces;
}

}  // namespace evert
