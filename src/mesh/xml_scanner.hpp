#pragma once
#include "input_cursor.hpp"
#include <map>
#include <string>
#include <string_view>

namespace evert {

/// A tag of an XML file.
struct XmlTag {
  enum Kind { start, end, empty };  ///< <a>, </a>, <a/>

  Kind kind = start;
  std::string name;
  std::map<std::string, std::string, std::less<>> attributes;
  std::size_t position = 0;  ///< of its '<' in the file

  /// The attribute, or `otherwise` when there is none.
  [[nodiscard]] std::string attribute(std::string_view key, std::string_view otherwise = "") const;
};

/// Goes through the tags of an XML file one by one. No XML library does here: VTU files may carry raw binary
/// data, which is not XML, and errors must name the line.
class XmlScanner {
 public:
  explicit XmlScanner(InputCursor& in) : in_(in) {}

  /// The next tag; comments and declarations are passed by. Throws UserError at the end of the file.
  [[nodiscard]] XmlTag next();
  /// The text between here and the next tag.
  [[nodiscard]] std::string_view text();

 private:
  void read_attributes(std::string_view text, XmlTag& tag) const;

  InputCursor& in_;
};

}  // namespace evert
