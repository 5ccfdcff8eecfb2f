#include "evert/core/formatted.hpp"
#include "evert/trade/front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evert::trade {
namespace {

constexpr double width = 760, left = 84, right = 24, top = 48, plot_height = 430, below = 58, row = 22;

/// A range of a logarithmic axis with room at both ends.
struct LogRange {
  double low = std::numeric_limits<double>::infinity(), high = 0;

  void include(double value) {
    if (!(value > 0) || !std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void finish() {
    if (high == 0) *this = {0.1, 1};
    const double room = std::max(std::pow(high / low, 0.08), 1.3);
    low /= room;
    high *= room;
  }
  [[nodiscard]] double share(double value) const {
    return std::log(std::clamp(value, low, high) / low) / std::log(high / low);
  }
};

/// 1, 2 and 5 times powers of ten, or the powers alone where the range is long.
std::vector<double> ticks(const LogRange& range) {
  std::vector<double> out;
  const bool few = range.high / range.low > 2e3;
  for (int e = static_cast<int>(std::floor(std::log10(range.low))); std::pow(10, e) <= range.high; ++e)
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = factor * std::pow(10, e);
      if (tick >= range.low && tick <= range.high && (factor == 1 || !few)) out.push_back(tick);
    }
  return out;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else
      out += c;
  }
  return out;
}

std::string text_at(double x, double y, const std::string& words, const char* style) {
  return formatted("<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, style) + escaped(words) + "</text>\n";
}

/// Maps cost and error to the page.
class Page {
 public:
  Page(std::span<const Trial> trials, double reference_error) {
    for (const auto& trial : trials) {
      cost_.include(trial.cost);
      if (trial.usable()) error_.include(trial.errors.displacement);
    }
    error_.include(reference_error);
    cost_.finish();
    error_.finish();
  }
  [[nodiscard]] double x(double cost) const { return left + (width - left - right) * cost_.share(cost); }
  [[nodiscard]] double y(double error) const { return top + plot_height * (1 - error_.share(error)); }

  [[nodiscard]] std::string grid() const {
    std::string out;
    const double bottom = top + plot_height;
    for (const double tick : ticks(cost_)) {
      out += formatted("<path d=\"M%.1f,%.1fV%.1f\" stroke=\"#ddd\"/>\n", x(tick), top, bottom);
      out += text_at(x(tick), bottom + 20, formatted("%g", tick), "text-anchor=\"middle\"");
    }
    for (const double tick : ticks(error_)) {
      out += formatted("<path d=\"M%.1f,%.1fH%.1f\" stroke=\"#ddd\"/>\n", left, y(tick), width - right);
      out += text_at(left - 8, y(tick) + 5, formatted("%g", 100 * tick), "text-anchor=\"end\"");
    }
    out += formatted("<path d=\"M%.1f,%.1fV%.1fH%.1f\" fill=\"none\" stroke=\"#000\"/>\n", left, top, bottom,
                     width - right);
    out += text_at(0.5 * (left + width - right), bottom + 44, "cost [CPU s per simulated s]",
                   "text-anchor=\"middle\"");
    return out + formatted(
                     "<text transform=\"translate(22,%.1f) rotate(-90)\" text-anchor=\"middle\">error "
                     "of the displacement [%%]</text>\n",
                     top + 0.5 * plot_height);
  }

 private:
  LogRange cost_, error_;
};

std::string front_line(const Page& page, std::span<const Trial> trials, std::span<const std::size_t> front) {
  std::string path;
  for (const auto i : front)
    path += formatted("%s%.1f,%.1f", path.empty() ? "M" : "L", page.x(trials[i].cost),
                      page.y(trials[i].errors.displacement));
  return path.empty() ? "" : "<path d=\"" + path + "\" fill=\"none\" stroke=\"#000\" stroke-width=\"2\"/>\n";
}

std::string marks(const Page& page, std::span<const Trial> trials, std::span<const std::size_t> front) {
  std::string out;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto& trial = trials[i];
    const double x = page.x(trial.cost);
    if (!trial.usable() && trial.cost > 0)
      out += formatted("<path d=\"M%.1f,%.1fl10,10m0,-10l-10,10\" stroke=\"#777\" stroke-width=\"2\"/>\n",
                       x - 5, top + 3);
    else if (trial.usable() && std::ranges::find(front, i) == front.end())
      out += formatted(
          "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4.5\" fill=\"#fff\" stroke=\"#777\" stroke-width=\"1.5\"/>\n",
          x, page.y(trial.errors.displacement));
  }
  for (std::size_t f = 0; f < front.size(); ++f) {
    const auto& trial = trials[front[f]];
    const double x = page.x(trial.cost), y = page.y(trial.errors.displacement);
    out += formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"10\" fill=\"#000\"/>\n", x, y);
    out += text_at(x, y + 4.5, std::to_string(f + 1),
                   "text-anchor=\"middle\" fill=\"#fff\" font-size=\"13\" font-weight=\"bold\"");
  }
  return out;
}

std::string key_line(double y) {
  return formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"8\" fill=\"#000\"/>\n", left + 8, y - 5) +
         text_at(left + 22, y, "Pareto front", "") +
         formatted(
             "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4.5\" fill=\"#fff\" stroke=\"#777\" "
             "stroke-width=\"1.5\"/>\n",
             left + 150, y - 5) +
         text_at(left + 162, y, "other settings", "") +
         formatted("<path d=\"M%.1f,%.1fl10,10m0,-10l-10,10\" stroke=\"#777\" stroke-width=\"2\"/>\n",
                   left + 292, y - 10) +
         text_at(left + 310, y, "did not finish: unstable, too slow", "");
}

/// Of letters half as wide as they are high, on one line.
double fitting_size(const std::string& words) {
  constexpr double usual = 16, letter = 0.55;
  return std::min(usual, (width - left - right) / (letter * static_cast<double>(words.size())));
}

}  // namespace

std::string plot_of(const std::string& title, std::span<const Trial> trials,
                    std::span<const std::size_t> front, double reference_error) {
  const Page page(trials, reference_error);
  const double bottom = top + plot_height + below;
  const double height = bottom + row * (static_cast<double>(front.size()) + 2);
  std::string out = formatted(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" font-family=\"sans-serif\" "
      "font-size=\"16\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
      width, height);
  out += text_at(left, 28, title, "font-weight=\"bold\" font-size=\"18\"") + page.grid();
  if (reference_error > 0) {
    out += formatted("<path d=\"M%.1f,%.1fH%.1f\" stroke=\"#000\" stroke-dasharray=\"3 5\"/>\n", left,
                     page.y(reference_error), width - right);
    out += text_at(width - right, page.y(reference_error) - 6, "error of the finest run",
                   "text-anchor=\"end\" font-size=\"14\"");
  }
  out += front_line(page, trials, front) + marks(page, trials, front) + key_line(bottom + 12);
  for (std::size_t f = 0; f < front.size(); ++f) {
    const auto& trial = trials[front[f]];
    const auto words = formatted("%zu  %s: %s, %.3g s/s", f + 1, trial.label.c_str(),
                                 percent(trial.errors.displacement).c_str(), trial.cost);
    out += text_at(left, bottom + 18 + row * (static_cast<double>(f) + 1), words,
                   formatted("font-size=\"%.1f\"", fitting_size(words)).c_str());
  }
  return out + "</svg>\n";
}

}  // namespace evert::trade
