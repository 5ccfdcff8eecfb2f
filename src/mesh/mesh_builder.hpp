#pragma once
#include "evert/mesh/mesh.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace evert {

/// Where a cell stands in the mesh.
struct CellPlace {
  CellType type = CellType::tet4;
  std::size_t index = 0;  ///< in the block of its type
};

/// Collects what a mesh file lists one by one and puts it in the order that Mesh promises.
class MeshBuilder {
 public:
  void reserve_nodes(GlobalIndex count) { mesh_.nodes.reserve(static_cast<std::size_t>(count)); }
  /// Returns the number of the node.
  GlobalIndex add_node(const Vec3d& position);
  [[nodiscard]] GlobalIndex node_count() const { return mesh_.node_count(); }

  /// Number of the region of that name, made when it is new.
  [[nodiscard]] std::int32_t region(const std::string& name);
  /// `nodes`: node_count(type) valid numbers in VTK order.
  CellPlace add_cell(CellType type, std::span<const GlobalIndex> nodes, std::int32_t region);
  /// Gives a cell its vector. Once one cell has a vector, the others have 0.
  void set_vector(const CellPlace& cell, const Vec3d& vector);
  void add_to_node_set(const std::string& name, std::span<const GlobalIndex> nodes);
  /// Notes a cell of lower dimension, so that a file without volume cells can be told what it has instead.
  void count_lower_cell(std::string_view kind) { ++lower_cells_[std::string(kind)]; }

  /// Throws UserError when there is no volume cell; `file` is its name in the message.
  [[nodiscard]] Mesh finish(const std::string& file) &&;

 private:
  Mesh mesh_;
  std::array<CellBlock, all_cell_types.size()> blocks_;
  std::unordered_map<std::string, std::int32_t> region_numbers_;
  std::unordered_map<std::string, std::size_t> node_set_numbers_;
  std::map<std::string, GlobalIndex> lower_cells_;
  bool has_vectors_ = false;
};

}  // namespace evert
