#include "evert/app/extremes_command.hpp"

#include "evert/app/command_line.hpp"
#include "evert/core/collective.hpp"
#include "evert/io/files.hpp"

#include "command_options.hpp"
#include "extremes_report.hpp"
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

namespace evert {
namespace {

constexpr const char* help =
    R"(evert extremes [NAME] [options]: runs scenes as bad as they can be, and grades what comes out

  NAME                       the cases with NAME in theirs; all without it
  -list                      the names of the cases; runs nothing
  -write DIR                 the scene of the one case with that name, for evert run; runs nothing
  -out FILE                  a table for each kind of case, in Markdown; what the file has below the line
                             <!-- not made by evert extremes --> stays there
  -time_limit S              wall time that a case may take; 60 s unless given
  -quiet                     of the cases, only those that do not keep their promise

Each case ends recovered, stable, or failed with a message. The exit code is 1 if one does not, or not as it must: bodies
that must recover, or be stable, or steps that must be found too long. On several ranks all of them share each case.
)";

constexpr double default_time_limit = 60;  // [s]

/// What a signal handler may still do: says which case hangs, and ends the program.
std::string running;  // NOLINT: the handler has no arguments
void give_up(int /*signal*/) {
  constexpr const char* before = "evert: bug: hangs: ";
  static_cast<void>(!write(STDERR_FILENO, before, std::strlen(before)));
  static_cast<void>(!write(STDERR_FILENO, running.data(), running.size()));
  static_cast<void>(!write(STDERR_FILENO, "\n", 1));
  _exit(1);
}

/// A directory on rank 0 for the files of a case, while this lives.
class ScratchDirectory {
 public:
  explicit ScratchDirectory(MPI_Comm comm) : root_(rank_of(comm) == 0) {
    int process = getpid();
    MPI_Bcast(&process, 1, MPI_INT, 0, comm);
    path_ = std::filesystem::temp_directory_path() / ("evert_extremes_" + std::to_string(process));
    on_root(comm, [&] { std::filesystem::create_directories(path_); });
  }
  ~ScratchDirectory() {
    std::error_code error;
    if (root_) std::filesystem::remove_all(path_, error);
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  bool root_;
  std::filesystem::path path_;
};

std::vector<ExtremeCase> cases_named(MPI_Comm comm, const std::string& part) {
  auto cases = extreme_cases(size_of(comm));
  std::vector<std::string> families;
  for (const auto& one : cases)
    if (families.empty() || families.back() != one.family) families.push_back(one.family);
  std::erase_if(cases, [&](const ExtremeCase& one) { return one.name().find(part) == std::string::npos; });
  if (cases.empty())
    throw UserError("evert extremes: there is no case with '" + part +
                    "' in its name: evert extremes -list shows all" + did_you_mean(part, families));
  return cases;
}

int write_one(MPI_Comm comm, const std::vector<ExtremeCase>& cases, const std::string& directory,
              std::ostream& out) {
  const auto& one = cases.front();
  if (cases.size() > 1)
    throw UserError("evert extremes: -write needs the name of one case, not of " +
                    std::to_string(cases.size()) + ", as '" + one.name() + "'");
  on_root(comm, [&] { require_writable((std::filesystem::path(directory) / "scene.yaml").string()); });
  const auto path = write_case(comm, one, directory);
  if (rank_of(comm) == 0) out << "evert run " << path << '\n';
  return 0;
}

/// Takes the directory of a case's files out of what is said about it.
std::string without_directory(std::string message, const std::string& directory) {
  for (auto at = message.find(directory + "/"); at != std::string::npos; at = message.find(directory + "/"))
    message.erase(at, directory.size() + 1);
  return message;
}

std::vector<TriedCase> try_all(MPI_Comm comm, const std::vector<ExtremeCase>& cases, double time_limit,
                               bool quiet, std::ostream& out) {
  constexpr double patience = 3;  // a step that does not end, of which the run itself cannot know
  const ScratchDirectory scratch(comm);
  std::signal(SIGALRM, give_up);
  std::vector<TriedCase> tried;
  for (const auto& one : cases) {
    running = one.name();
    alarm(static_cast<unsigned>(patience * time_limit) + 10);
    tried.push_back({one, try_case(comm, one, scratch.path(), time_limit)});
    auto& note = tried.back().trial.note;
    note = without_directory(note, scratch.path());
    if (rank_of(comm) == 0 && !(quiet && tried.back().trial.kept)) write_line(tried.back(), out);
  }
  alarm(0);
  return tried;
}

/// 0, or 1 and a line on standard error.
int exit_code_of(const std::vector<TriedCase>& tried, bool root) {
  const auto is_broken = [](const TriedCase& one) { return !one.trial.kept; };
  const auto broken = std::ranges::count_if(tried, is_broken);
  if (broken == 0) return 0;
  const auto first = std::ranges::find_if(tried, is_broken);
  if (root)
    std::fprintf(stderr, "evert: %td of %zu cases did not end as they must; the first is %s: %s\n", broken,
                 tried.size(), first->extreme.name().c_str(), first->trial.note.c_str());
  return 1;
}

/// What the file at `path`, which a new one replaces, has below this line, and the line; "": there is none.
std::string written_by_others(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) return "";  // a pipe would be waited for
  constexpr const char* line = "<!-- not made by evert extremes -->\n";
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  const auto begin = text.str().find(line);
  return begin == std::string::npos ? "" : text.str().substr(begin);
}

std::string command_of(std::span<const std::string> arguments) {
  std::string text = "evert extremes";
  for (const auto& argument : arguments) text += " " + argument;
  return text;
}

}  // namespace

int extremes_command(MPI_Comm comm, std::span<const std::string> arguments, std::ostream& out) {
  const bool root = rank_of(comm) == 0;
  if (asks_for_help(arguments)) {
    if (root) out << help;
    return 0;
  }
  const bool is_named = !arguments.empty() && !arguments.front().starts_with('-');
  const CommandOptions options("evert extremes", arguments.subspan(is_named ? 1 : 0),
                               {"write", "out", "time_limit"}, {"list", "quiet"}, {});
  const auto cases = cases_named(comm, is_named ? arguments.front() : "");
  if (options.has("list")) {
    for (const auto& one : cases)
      if (root) out << one.name() << '\n';
    return 0;
  }
  if (options.has("write")) return write_one(comm, cases, options.text("write"), out);
  const double time_limit = options.has("time_limit") ? options.number("time_limit") : default_time_limit;
  if (!(time_limit > 0)) throw UserError("evert extremes: -time_limit must be more than 0 s");
  if (options.has("out")) on_root(comm, [&] { require_writable(options.text("out")); });

  const auto tried = try_all(comm, cases, time_limit, options.has("quiet"), out);

  if (root) {
    write_totals(tried, out);
    out.flush();
  }
  if (options.has("out"))
    on_root(comm, [&] {
      std::ostringstream text;
      write_document(tried, command_of(arguments), text);
      text << written_by_others(options.text("out"));
      write_file(options.text("out"), text.str());
    });
  return exit_code_of(tried, root);
}

}  // namespace evert
