#pragma once
#include "input_cursor.hpp"
#include <cstdint>
#include <vector>

namespace evert {

/// The numbers that a file gives its nodes, in any order and with gaps, and the place of each in Mesh::nodes.
class NodeTags {
 public:
  /// The next node of the mesh has this tag. The cursor stands at it.
  void add(std::int64_t tag, const InputCursor& in) {
    entries_.push_back({tag, static_cast<GlobalIndex>(entries_.size()), in.last_position()});
  }
  /// To be called once, after the last add. Throws UserError when a tag was given twice.
  void close(const InputCursor& in);
  /// Place of the node with this tag. Throws UserError through `in` when there is none.
  [[nodiscard]] GlobalIndex index_of(std::int64_t tag, const InputCursor& in) const;

 private:
  struct Entry {
    std::int64_t tag;
    GlobalIndex index;
    std::size_t position;  // in the file
  };
  std::vector<Entry> entries_;  // by rising tag once closed
};

}  // namespace evert
