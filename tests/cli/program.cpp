#include "program.hpp"

#include <fcntl.h>
#include <fstream>
#include <signal.h>
#include <spawn.h>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace evert::cli {
namespace {

constexpr auto poll_interval = std::chrono::milliseconds(5);
constexpr auto grace = std::chrono::seconds(5);

std::string read_file(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// Starts a program in `place` in a process group of its own, with its output in files.
pid_t start(std::vector<std::string>& command, const std::filesystem::path& place,
            const std::filesystem::path& out, const std::filesystem::path& err) {
  std::vector<char*> arguments;
  for (auto& part : command) arguments.push_back(part.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addchdir_np(&actions, place.c_str());
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t process = 0;
  const int code = posix_spawnp(&process, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (code != 0) throw std::runtime_error("cannot start " + command[0]);
  return process;
}

/// Waits until the process ends or `limit` has passed; true when it ended.
bool wait_for(pid_t process, std::chrono::milliseconds limit, int& status) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (waitpid(process, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(poll_interval);
  }
  return true;
}

/// The lines that ranks wrote: under mpirun --tag-output those marked "[job,rank]<stderr>:", without the
/// mark.
std::vector<std::string> lines_of_ranks(const std::string& text, bool tagged) {
  constexpr std::string_view mark = "<stderr>:";
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    const auto place = line.find(mark);
    if (!tagged)
      lines.push_back(line);
    else if (line.starts_with("[") && place != std::string::npos)
      lines.push_back(line.substr(place + mark.size()));
  }
  return lines;
}

}  // namespace

Outcome run_evert(const std::vector<std::string>& arguments, int ranks, const std::filesystem::path& place,
                  std::chrono::seconds limit) {
  std::vector<std::string> command;
  if (ranks > 1) command = {EVERT_MPIEXEC, "--tag-output", "-n", std::to_string(ranks)};
  command.emplace_back(EVERT_PROGRAM);
  command.insert(command.end(), arguments.begin(), arguments.end());

  const std::filesystem::path out = place.string() + ".out";
  const std::filesystem::path err = place.string() + ".err";
  const pid_t process = start(command, place, out, err);
  Outcome outcome;
  int status = 0;
  if (!wait_for(process, limit, status)) {
    outcome.timed_out = true;
    kill(-process, SIGTERM);  // mpirun takes its ranks along
    if (!wait_for(process, grace, status)) {
      kill(-process, SIGKILL);
      waitpid(process, &status, 0);
    }
  }
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.output = read_file(out);
  outcome.errors = lines_of_ranks(read_file(err), ranks > 1);
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return outcome;
}

std::vector<std::string> split(const std::string& command) {
  std::vector<std::string> parts;
  std::string part;
  bool quoted = false;
  for (const char c : command + " ") {
    if (c == '\'') {
      quoted = !quoted;
    } else if (c == ' ' && !quoted) {
      if (!part.empty()) parts.push_back(part);
      part.clear();
    } else {
      part += c;
    }
  }
  return parts;
}

}  // namespace evert::cli
