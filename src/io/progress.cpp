#include "evert/io/progress.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/formatted.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sys/ioctl.h>
#include <unistd.h>

namespace evert {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds rewriting_interval{0.2};
constexpr Seconds lines_interval{5};

/// Open MPI's mpirun reads its children through a pseudo-terminal: what counts is where its own output goes.
bool is_terminal(int descriptor) {
  if (isatty(descriptor) == 0) return false;
  if (std::getenv("OMPI_COMM_WORLD_RANK") == nullptr) return true;
  std::error_code error;
  const auto target = std::filesystem::read_symlink(
      "/proc/" + std::to_string(getppid()) + "/fd/" + std::to_string(descriptor), error);
  return !error && (target.native().starts_with("/dev/pts/") || target.native().starts_with("/dev/tty"));
}

/// Columns of the terminal behind `file`; 0 when unknown.
std::size_t width_of(std::FILE* file) {
  winsize size{};
  return ioctl(fileno(file), TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

}  // namespace

ProgressStyle progress_style(bool quiet) {
  if (quiet) return ProgressStyle::silent;
  return is_terminal(STDOUT_FILENO) ? ProgressStyle::rewriting : ProgressStyle::lines;
}

std::string duration_text(double seconds) {
  constexpr double most = 1e15;  // beyond, and for NaN, a time says nothing
  if (!(seconds < most)) return "?";
  const auto whole = static_cast<std::int64_t>(std::ceil(std::max(seconds, 0.0)));
  const auto two = [](std::int64_t large, const char* large_unit, std::int64_t small,
                      const char* small_unit) {
    return std::to_string(large) + large_unit + std::to_string(small) + small_unit;
  };
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return two(whole / 60, " min ", whole % 60, " s");
  if (whole < 86400) return two(whole / 3600, " h ", whole % 3600 / 60, " min");
  return two(whole / 86400, " d ", whole % 86400 / 3600, " h");
}

Progress::Progress(MPI_Comm comm, ProgressStyle style, const ProgressState& begin, double end, std::FILE* out,
                   Clock::time_point now)
    : comm_(comm),
      style_(style),
      end_(end),
      out_(out),
      begin_(begin),
      shown_(begin),
      began_(now),
      shown_at_(now) {
  MPI_Bcast(&style_, sizeof style_, MPI_BYTE, 0, comm_);
}

bool Progress::due(Clock::time_point now) const {
  if (style_ == ProgressStyle::silent) return false;
  int due = now - shown_at_ >= (style_ == ProgressStyle::lines ? lines_interval : rewriting_interval) ? 1 : 0;
  MPI_Bcast(&due, 1, MPI_INT, 0, comm_);
  return due == 1;
}

std::string Progress::line(const ProgressState& state, Clock::time_point now) const {
  const double wall = Seconds(now - began_).count();
  const double advanced = state.time - begin_.time;
  const auto steps = state.steps - shown_.steps;
  const double since_shown = Seconds(now - shown_at_).count();
  std::string text = formatted("%3.0f %%  t = %.4g of %.4g s  %lld steps", 100 * state.time / end_,
                               state.time, end_, static_cast<long long>(state.steps));
  if (steps > 0 && since_shown > 0) text += formatted(", %.3g/s", static_cast<double>(steps) / since_shown);
  if (state.time < end_) {
    if (advanced > 0) text += "  " + duration_text((end_ - state.time) * wall / advanced) + " left";
  } else {
    text += "  in " + duration_text(wall);
  }
  text += formatted("  %lld inverted", static_cast<long long>(state.inverted));
  if (state.cg_iterations > begin_.cg_iterations && steps > 0)  // none where nothing is damped
    text += formatted("  CG %.1f/step", static_cast<double>(state.cg_iterations - shown_.cg_iterations) /
                                            static_cast<double>(steps));
  return text;
}

void Progress::show(const ProgressState& state, Clock::time_point now) {
  if (style_ == ProgressStyle::silent) return;
  if (rank_of(comm_) == 0) {
    auto text = line(state, now);
    if (style_ == ProgressStyle::rewriting) {
      if (const auto width = width_of(out_); width > 0 && text.size() >= width) text.resize(width - 1);
      std::fprintf(out_, "\r%s\x1b[K", text.c_str());  // and clears the rest of the line
    } else {
      std::fprintf(out_, "%s\n", text.c_str());
    }
    std::fflush(out_);
  }
  shown_ = state;
  shown_at_ = now;
}

void Progress::note(const std::string& text) {
  if (style_ == ProgressStyle::silent || rank_of(comm_) != 0) return;
  std::fprintf(out_, style_ == ProgressStyle::rewriting ? "\r%s\x1b[K\n" : "%s\n", text.c_str());
  std::fflush(out_);
}

void Progress::finish(const ProgressState& state, Clock::time_point now) {
  show(state, now);
  if (style_ == ProgressStyle::rewriting && rank_of(comm_) == 0) {
    std::fputc('\n', out_);
    std::fflush(out_);
  }
}

}  // namespace evert
