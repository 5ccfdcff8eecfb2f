#include "vector_field.hpp"

#include "evert/core/error.hpp"

#include <algorithm>

namespace evert {

bool VectorField::meet(std::string_view name, GlobalIndex components, const InputCursor& in) {
  if (!wanted()) return false;
  if (name != name_) {
    if (components == 3 && std::ranges::find(others_, name) == others_.end()) others_.emplace_back(name);
    return false;
  }
  if (components != 3)
    in.fail("the cell field '" + name_ + "' has " + std::to_string(components) +
            " components; it must have 3 to be one of vectors");
  found_ = true;
  return true;
}

void VectorField::expect_found(const std::string& file) const {
  if (!wanted() || found_) return;
  throw UserError(file + ": has no cell field of vectors called '" + name_ + "'; it has " +
                  (others_.empty() ? "none" : list_of(others_)) + did_you_mean(name_, others_));
}

}  // namespace evert
