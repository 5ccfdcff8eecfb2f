#include "evert/mesh/mesh.hpp"

#include <algorithm>
#include <numeric>

namespace evert {

int node_count(CellType type) {
  switch (type) {
    case CellType::tet4:
      return 4;
    case CellType::hex8:
      return 8;
    case CellType::wedge6:
      return 6;
    case CellType::tet10:
      return 10;
  }
  return 0;
}

std::string_view name_of(CellType type) {
  switch (type) {
    case CellType::tet4:
      return "tet4";
    case CellType::hex8:
      return "hex8";
    case CellType::wedge6:
      return "wedge6";
    case CellType::tet10:
      return "tet10";
  }
  return "";
}

GlobalIndex Mesh::cell_count() const {
  return std::accumulate(cells.begin(), cells.end(), GlobalIndex{0},
                         [](GlobalIndex sum, const CellBlock& block) { return sum + block.size(); });
}

const CellBlock* Mesh::block(CellType type) const {
  const auto found = std::ranges::find(cells, type, &CellBlock::type);
  return found == cells.end() ? nullptr : &*found;
}

}  // namespace evert
