#include "evert/app/explain_command.hpp"

#include "evert/app/command_line.hpp"
#include "evert/core/error.hpp"
#include "evert/scene/reference.hpp"

namespace evert {
namespace {

constexpr const char* help = R"(evert explain          every key of a scene, with what it means
evert explain KEY      all about one key: type, unit, range, default, an example
evert explain -markdown
                       the reference as one page, docs/reference/scene.md

Keys may be given by their end: friction, or obstacles.friction, or obstacles.<name>.friction.
)";

}  // namespace

int explain_command(std::span<const std::string> arguments, std::ostream& out) {
  if (asks_for_help(arguments)) {
    out << help;
    return 0;
  }
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
