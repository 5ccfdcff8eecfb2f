#include "evert/app/explain_command.hpp"

#include "evert/core/error.hpp"
#include "evert/scene/reference.hpp"

namespace evert {

int explain_command(std::span<const std::string> arguments, std::ostream& out) {
  if (arguments.size() > 1)
    throw UserError("'" + arguments[1] +
                    "' is one argument too many: evert explain takes one key, or -markdown");
  if (arguments.empty()) {
    out << reference_tree();
  } else if (const auto& argument = arguments.front(); argument == "-markdown" || argument == "--markdown") {
    out << reference_markdown();
  } else if (argument.starts_with('-')) {
    throw UserError("evert explain: unknown option " + argument + ": it takes a key, or -markdown");
  } else {
    out << reference_of(argument);
  }
  return 0;
}

}  // namespace evert
