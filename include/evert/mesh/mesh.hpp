#pragma once
#include "evert/core/index.hpp"
#include "evert/math/vec3.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// A whole unstructured mesh on one rank: what readers and generators make and partitioning distributes.
namespace evert {

/// Cell types, with VTK's node order.
enum class CellType : std::uint8_t { tet4, hex8, wedge6, tet10 };

inline constexpr std::array all_cell_types{CellType::tet4, CellType::hex8, CellType::wedge6, CellType::tet10};

/// Nodes of one cell: 4, 8, 6, 10.
[[nodiscard]] int node_count(CellType type);
/// "tet4", "hex8", "wedge6", "tet10".
[[nodiscard]] std::string_view name_of(CellType type);

/// All cells of one type. At most one block of each type in a mesh; blocks in the order of CellType.
struct CellBlock {
  CellType type = CellType::tet4;
  std::vector<GlobalIndex> nodes;    ///< node_count(type) per cell, VTK order
  std::vector<std::int32_t> region;  ///< per cell: index into Mesh::regions
  std::vector<Vec3d> vectors{};      ///< per cell, or empty: a field of vectors, e.g. where fibres run to

  [[nodiscard]] GlobalIndex size() const { return static_cast<GlobalIndex>(region.size()); }
};

/// A named set of nodes, e.g. those of a physical surface of the mesh file. Sorted, without repetition.
struct NodeSet {
  std::string name;
  std::vector<GlobalIndex> nodes;
};

struct Mesh {
  std::vector<Vec3d> nodes;          ///< rest positions [m]
  std::vector<CellBlock> cells;      ///< one block per cell type present
  std::vector<std::string> regions;  ///< names of the volume groups; never empty when there are cells
  std::vector<NodeSet> node_sets;

  [[nodiscard]] GlobalIndex node_count() const { return static_cast<GlobalIndex>(nodes.size()); }
  [[nodiscard]] GlobalIndex cell_count() const;
  /// The block of `type`, or nullptr.
  [[nodiscard]] const CellBlock* block(CellType type) const;
};

}  // namespace evert
