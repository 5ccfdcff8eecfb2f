#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace evert {

/// With padding, without line breaks.
[[nodiscard]] std::string to_base64(std::string_view bytes);

/// The first `size` bytes of what `text` encodes; blanks are skipped, and padding may stand inside, where
/// encoded pieces were joined. Fewer bytes when the text ends before; nothing when another character stands
/// in it.
[[nodiscard]] std::optional<std::string> from_base64(std::string_view text, std::size_t size);

}  // namespace evert
