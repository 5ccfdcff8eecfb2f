#include "split_hexahedra.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace evert {
namespace {

using Quad = std::array<std::size_t, 4>;
/// Of a hex8, seen from outside counterclockwise.
constexpr std::array<Quad, 6> faces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

}  // namespace

CellBlock split_hexahedra(const CellBlock& hexahedra) {
  CellBlock tets{CellType::tet4, {}, {}};
  for (std::size_t c = 0; c < hexahedra.region.size(); ++c) {
    const auto nodes = std::span(hexahedra.nodes).subspan(8 * c, 8);
    const GlobalIndex apex = *std::ranges::min_element(nodes);
    for (const Quad& face : faces) {
      std::array<GlobalIndex, 4> quad{};
      for (std::size_t i = 0; i < 4; ++i) quad[i] = nodes[face[i]];
      if (std::ranges::find(quad, apex) != quad.end()) continue;
      std::ranges::rotate(quad, std::ranges::min_element(quad));
      for (const std::size_t i : {1, 2}) {
        tets.nodes.insert(tets.nodes.end(), {quad[0], quad[i + 1], quad[i], apex});
        tets.region.push_back(hexahedra.region[c]);
      }
    }
  }
  return tets;
}

}  // namespace evert
