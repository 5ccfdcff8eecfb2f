#pragma once
#include "input_cursor.hpp"
#include <cstdint>
#include <string_view>
#include <vector>

namespace evert {

/// A number type of VTK's files.
struct VtkNumberType {
  enum Kind { signed_integer, unsigned_integer, real };

  std::string_view legacy_name;  ///< in .vtk files
  std::string_view xml_name;     ///< in .vtu files
  std::size_t bytes;
  Kind kind;
};

/// The type with this name in legacy files, or in XML files; nullptr when there is none.
[[nodiscard]] const VtkNumberType* legacy_number_type(std::string_view name);
[[nodiscard]] const VtkNumberType* xml_number_type(std::string_view name);

/// Reads one number, as text or as bytes. A real one must be finite.
[[nodiscard]] std::int64_t read_integer(InputCursor& in, const VtkNumberType& type, bool binary, bool swap,
                                        std::string_view what);
[[nodiscard]] double read_real(InputCursor& in, const VtkNumberType& type, bool binary, bool swap,
                               std::string_view what);

}  // namespace evert
