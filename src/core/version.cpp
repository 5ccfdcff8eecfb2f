#include "evert/core/version.hpp"

namespace evert {

std::string_view version() { return EVERT_VERSION; }

}  // namespace evert
