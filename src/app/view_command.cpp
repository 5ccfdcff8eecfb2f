#include "evert/app/view_command.hpp"

#include "evert/app/command_line.hpp"
#include "evert/core/error.hpp"
#include "evert/io/files.hpp"
#include "evert/io/html_view.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <vector>

namespace evert {
namespace {

constexpr const char* help =
    R"(evert view RUN.h5 [options]: makes one web page that plays the frames of a run in any browser

  -o page.html               where to write; beside the run unless given
  -frames 240                at most so many frames, evenly spaced
  -max_triangles 100000      larger surfaces are simplified
  -up y                      the axis that points up: x, y or z

The page needs neither a network nor anything installed, and can be mailed.
)";

struct ViewArguments {
  std::string run;
  std::string page;
  HtmlViewOptions options;
};

std::size_t count_from(const std::string& text, const std::string& option, std::size_t least) {
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc{} || end != text.data() + text.size() || count < least)
    throw UserError(option + " must be a whole number of at least " + std::to_string(least) + ", not '" +
                    text + "'");
  return count;
}

std::size_t axis_from(const std::string& text, const std::string& option) {
  const auto axis = std::string("xyz").find(text);
  if (text.size() != 1 || axis == std::string::npos)
    throw UserError(option + " must be x, y or z, not '" + text + "'");
  return axis;
}

ViewArguments parsed(std::span<const std::string> arguments) {
  const std::vector<std::string> known{"-o", "-frames", "-max_triangles", "-up"};
  ViewArguments view;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const auto& argument = arguments[i];
    if (!argument.starts_with('-')) {
      if (!view.run.empty())
        throw UserError("'" + argument + "' is one argument too many: evert view takes one run file");
      view.run = argument;
      continue;
    }
    const auto option = argument.starts_with("--") ? argument.substr(1) : argument;
    if (std::ranges::find(known, option) == known.end())
      throw UserError("evert view: there is no option " + argument + ": must be " + list_of(known) +
                      did_you_mean(option, known));
    if (i + 1 >= arguments.size()) throw UserError("evert view: " + argument + " needs a value");
    const auto& value = arguments[++i];
    if (option == "-o") view.page = value;
    if (option == "-frames") view.options.max_frames = count_from(value, option, 1);
    if (option == "-max_triangles") view.options.max_triangles = count_from(value, option, 100);
    if (option == "-up") view.options.up = axis_from(value, option);
  }
  if (view.run.empty()) throw UserError("evert view needs a run file: evert view run.h5");
  if (view.page.empty()) view.page = std::filesystem::path(view.run).replace_extension(".html").string();
  return view;
}

void require_file(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) throw UserError(path + ": there is no such file");
  if (std::filesystem::is_directory(path, none)) throw UserError(path + ": is a directory");
}

/// "torus_puddle/run.h5": most run files have the same name.
std::string title_of(const std::filesystem::path& run) {
  const auto directory = std::filesystem::absolute(run).lexically_normal().parent_path().filename();
  return (directory / run.filename()).string();
}

}  // namespace

int view_command(std::span<const std::string> arguments, std::ostream& out) {
  if (asks_for_help(arguments)) {
    out << help;
    return 0;
  }
  auto [run_path, page_path, options] = parsed(arguments);
  require_file(run_path);
  std::error_code none;
  if (std::filesystem::equivalent(run_path, page_path, none))
    throw UserError("'" + page_path + "' is the run itself: give the page another name with -o");
  require_writable(page_path);
  const RunReader run(run_path);
  options.title = title_of(run_path);
  const auto view = html_view(run, options);
  write_file(page_path, view.page);

  if (view.frames < run.frames().size())
    out << view.frames << " of " << run.frames().size() << " frames are shown, "
        << (view.cut_to_size
                ? "so that the page stays below " + std::to_string(options.max_bytes / 1'000'000) + " MB"
                : "-frames " + std::to_string(run.frames().size()) + " shows all")
        << '\n';
  if (view.triangles < view.surface_triangles)
    out << "The surface of " << view.surface_triangles << " triangles is simplified to " << view.triangles
        << ", -max_triangles " << view.surface_triangles << " shows all\n";
  out << page_path << ": " << view.frames << " frames, " << view.triangles << " triangles, "
      << (view.page.size() + 99'999) / 100'000 / 10.0 << " MB: open it in a browser\n";
  return 0;
}

}  // namespace evert
