#pragma once
#include "input_cursor.hpp"
#include "xml_scanner.hpp"
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace evert {

/// How a VTU file stores its arrays: from its first tag.
struct VtuEncoding {
  bool swap = false;             ///< numbers stand in the other byte order
  std::size_t header_bytes = 4;  ///< of the sizes in front of the data
  bool compressed = false;       ///< by zlib
  /// After the '_' of AppendedData.
  std::string_view appended;
  bool appended_is_base64 = false;
};

/// A DataArray of a VTU file, not looked into yet.
struct VtuArray {
  XmlTag tag;
  std::string_view text;  ///< between its tags
};

/// Its numbers. `what` names them in messages. Throws UserError through `in`.
[[nodiscard]] std::vector<std::int64_t> vtu_integers(const VtuArray& array, const VtuEncoding& encoding,
                                                     const InputCursor& in, std::string_view what);
[[nodiscard]] std::vector<double> vtu_reals(const VtuArray& array, const VtuEncoding& encoding,
                                            const InputCursor& in, std::string_view what);
/// The strings of an array of type String: characters as numbers, each string ended by 0.
[[nodiscard]] std::vector<std::string> vtu_strings(const VtuArray& array, const VtuEncoding& encoding,
                                                   const InputCursor& in);

}  // namespace evert
