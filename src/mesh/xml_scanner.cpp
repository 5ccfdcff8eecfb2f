#include "xml_scanner.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace evert {
namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string_view without_blanks(std::string_view text) {
  const auto begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string unescaped(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> entities{
      {{"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}}};
  std::string result;
  while (!text.empty()) {
    const auto entity =
        std::ranges::find_if(entities, [&](const auto& e) { return text.starts_with(e.first); });
    result += entity == entities.end() ? text.front() : entity->second;
    text.remove_prefix(entity == entities.end() ? 1 : entity->first.size());
  }
  return result;
}

}  // namespace

std::string XmlTag::attribute(std::string_view key, std::string_view otherwise) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? std::string(otherwise) : found->second;
}

XmlTag XmlScanner::next() {
  while (true) {
    static_cast<void>(text());
    const auto position = in_.position();
    const auto rest = in_.rest();
    if (rest.empty()) in_.fail_at(position, "the file ends where an XML tag is expected (truncated?)");
    const bool comment = rest.starts_with("<!--");
    const std::string_view closing = comment ? "-->" : ">";
    const auto length = rest.find(closing);
    if (length == std::string_view::npos) in_.fail_at(position, "this XML tag does not end (truncated?)");
    in_.set_position(position + length + closing.size());
    if (comment || rest.starts_with("<?") || rest.starts_with("<!")) continue;

    XmlTag tag;
    tag.position = position;
    auto inside = rest.substr(1, length - 1);
    if (inside.starts_with('/')) {
      tag.kind = XmlTag::end;
      inside.remove_prefix(1);
    } else if (inside.ends_with('/')) {
      tag.kind = XmlTag::empty;
      inside.remove_suffix(1);
    }
    inside = without_blanks(inside);
    const auto name = inside.substr(0, inside.find_first_of(blanks));
    tag.name = name;
    if (name.empty()) in_.fail_at(position, "this XML tag has no name");
    read_attributes(inside.substr(name.size()), tag);
    return tag;
  }
}

std::string_view XmlScanner::text() {
  const auto rest = in_.rest();
  const auto length = std::min(rest.find('<'), rest.size());
  in_.set_position(in_.position() + length);
  return rest.substr(0, length);
}

void XmlScanner::read_attributes(std::string_view text, XmlTag& tag) const {
  for (text = without_blanks(text); !text.empty(); text = without_blanks(text)) {
    const auto equals = text.find('=');
    const auto key = without_blanks(text.substr(0, equals));
    auto value =
        equals == std::string_view::npos ? std::string_view{} : without_blanks(text.substr(equals + 1));
    const char quote = value.empty() ? '\0' : value.front();
    const auto end = value.empty() ? std::string_view::npos : value.find(quote, 1);
    if (key.empty() || (quote != '"' && quote != '\'') || end == std::string_view::npos)
      in_.fail_at(tag.position, "the attributes of <" + tag.name + "> must have the form name=\"value\"");
    tag.attributes[std::string(key)] = unescaped(value.substr(1, end - 1));
    text = value.substr(end + 1);
  }
}

}  // namespace evert
