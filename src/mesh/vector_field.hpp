#pragma once
#include "input_cursor.hpp"
#include <string>
#include <string_view>
#include <vector>

namespace evert {

/// The cell field of vectors that a caller of read_mesh wants, while its file is read.
class VectorField {
 public:
  /// "": none is wanted.
  explicit VectorField(std::string_view name) : name_(name) {}

  [[nodiscard]] bool wanted() const { return !name_.empty(); }
  [[nodiscard]] bool found() const { return found_; }
  /// To be called at every cell field with its name and its number of components. True when its values are to
  /// be read; throws UserError through `in` when it is the one, but no vectors.
  [[nodiscard]] bool meet(std::string_view name, GlobalIndex components, const InputCursor& in);
  /// Throws UserError unless the field has been met, or none is wanted.
  void expect_found(const std::string& file) const;

 private:
  std::string name_;
  bool found_ = false;
  std::vector<std::string> others_;  // names of the fields of vectors that are not wanted
};

}  // namespace evert
