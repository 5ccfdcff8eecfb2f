#pragma once
#include <string_view>

namespace evert {

/// "major.minor.patch" of this library.
[[nodiscard]] std::string_view version();

}  // namespace evert
