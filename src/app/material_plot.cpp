#include "material_plot.hpp"

#include "evert/core/formatted.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>

namespace evert {
namespace {

constexpr std::array colours{"#2d6ca8", "#c8362b", "#3f8f5b", "#8a5fb0", "#c78a1e"};
constexpr int points = 200;
constexpr double panel_width = 330, panel_height = 250, left = 48, right = 10, top = 26, bottom = 36;
constexpr double legend_height = 62;

/// Maps stretch and stress to the page, and draws in one panel.
class Panel {
 public:
  Panel(double x, double y, double from, double to, double low, double high)
      : x_(x), y_(y), from_(from), to_(to), low_(low), high_(high) {}

  [[nodiscard]] double x(double s) const {
    return x_ + left + (panel_width - left - right) * (s - from_) / (to_ - from_);
  }
  [[nodiscard]] double y(double stress) const {
    return y_ + panel_height - bottom - (panel_height - top - bottom) * (stress - low_) / (high_ - low_);
  }
  [[nodiscard]] std::string line(double s1, double p1, double s2, double p2, const char* style) const {
    return formatted("<path d=\"M%.1f,%.1fL%.1f,%.1f\" %s/>\n", x(s1), y(p1), x(s2), y(p2), style);
  }
  /// What is drawn with clip-path="url(#c<number>)" stays inside.
  [[nodiscard]] std::string clip(std::size_t number) const {
    return formatted(
        "<clipPath id=\"c%zu\"><rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"/></clipPath>\n",
        number, x(from_), y(high_), x(to_) - x(from_), y(low_) - y(high_));
  }
  [[nodiscard]] std::string text(double px, double py, const char* anchor, const std::string& words) const {
    return formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", px, py, anchor,
                     words.c_str());
  }
  [[nodiscard]] std::string grid() const;

 private:
  double x_, y_, from_, to_, low_, high_;
};

/// 1, 2 or 5 times a power of ten, about `count` times in the range.
double tick(double range, double count) {
  const double power = std::pow(10, std::floor(std::log10(range / count)));
  for (const double factor : {1, 2, 5})
    if (factor * power * count >= 0.7 * range) return factor * power;
  return 10 * power;
}

std::string Panel::grid() const {
  std::string out;
  const double stress_step = tick(high_ - low_, 5), stretch_step = tick(to_ - from_, 6);
  for (double i = std::ceil(low_ / stress_step); i * stress_step <= high_; ++i) {
    const double p = i * stress_step;
    out += line(from_, p, to_, p, i == 0 ? "stroke=\"#6b7580\"" : "stroke=\"#e3e6ea\"");
    out += text(x(from_) - 5, y(p) + 4, "end", formatted("%g", p));
  }
  for (double i = std::ceil(from_ / stretch_step); i * stretch_step <= to_; ++i) {
    const double s = i * stretch_step;
    out += line(s, low_, s, high_, i == 0 ? "stroke=\"#6b7580\"" : "stroke=\"#e3e6ea\"");
    out += text(x(s), y(low_) + 15, "middle", formatted("%g", s));
  }
  return out;
}

std::vector<double> limits_of(const Material& material) {
  return std::visit(
      [](const auto& model) {
        std::vector<double> limits;
        if constexpr (requires { model.compression_limit; }) limits.push_back(model.compression_limit);
        if constexpr (requires { model.elongation_limit; }) limits.push_back(model.elongation_limit);
        return limits;
      },
      material);
}

/// Dashed where several stretches are negative, which no element sees.
std::string curve(const Panel& panel, const PointMaterial& at, const PathInfo& info, const char* colour,
                  double from, double to) {
  const bool dashes = info.path == DeformationPath::biaxial || info.path == DeformationPath::volumetric;
  std::array<std::string, 2> parts;  // from 0 on, and below
  for (int i = 0; i <= points; ++i) {
    const double s = from + (to - from) * i / points;
    const double stress = leading_stress(info.path, response_on_path(at, info.path, s));
    if (!std::isfinite(stress)) continue;
    auto& part = parts[dashes && s < 0 ? 1 : 0];
    // Far outside the panel some programs lose their way.
    const double y = std::clamp(panel.y(stress), -1e4, 1e4);
    part += formatted("%s%.1f,%.1f", part.empty() ? "M" : "L", panel.x(s), y);
  }
  std::string out;
  for (std::size_t i = 0; i < 2; ++i)
    if (!parts[i].empty())
      out += formatted("<path fill=\"none\" stroke-width=\"1.8\" stroke=\"%s\" %s d=\"", colour,
                       i == 1 ? "stroke-dasharray=\"2 4\"" : "") +
             parts[i] + "\"/>\n";
  return out;
}

/// The stress to show: all of the uniaxial curve, and 0. The others may leave the panel.
std::array<double, 2> stress_range(const PointMaterial& at, double from, double to) {
  std::array<double, 2> range{0, 0};
  for (int i = 0; i <= points; ++i) {
    const double s = from + (to - from) * i / points;
    const double stress = response_on_path(at, DeformationPath::uniaxial, s).stress(0, 0);
    if (!std::isfinite(stress)) continue;
    range = {std::min(range[0], stress), std::max(range[1], stress)};
  }
  if (range[0] == range[1]) range[1] = 1;
  const double margin = 0.08 * (range[1] - range[0]);
  return {range[0] - margin, range[1] + margin};
}

std::string panel_of(const PlottedMaterial& plotted, std::size_t number, double x, double y, double from,
                     double to) {
  const auto [low, high] = stress_range(plotted.point, from, to);
  const Panel panel(x, y, from, to, low, high);
  std::string out = panel.clip(number) + panel.grid();
  for (const double limit : limits_of(plotted.point.material))
    if (limit > from && limit < to)
      out += panel.line(limit, low, limit, high, "stroke=\"#b07d2b\" stroke-dasharray=\"5 3\"");
  out += formatted("<g clip-path=\"url(#c%zu)\">\n", number);
  const auto paths = paths_of(plotted.point.material);
  for (std::size_t i = 0; i < paths.size(); ++i)
    out += curve(panel, plotted.point, paths[i], colours[i], from, to);
  return out + "</g>\n" +
         panel.text(panel.x(0.5 * (from + to)), panel.y(high) - 8, "middle",
                    "<tspan font-weight=\"bold\">" + plotted.title + "</tspan>");
}

/// Three rows below the panels, for these paths.
std::string legend(double y, std::span<const PathInfo> paths) {
  std::string out;
  const auto entry = [&](double column, double row, const char* colour, const char* dashes,
                         const std::string& words) {
    const double ex = left + column, ey = y + 10 + 18 * row;
    out += formatted(
        "<path d=\"M%.1f,%.1fh22\" stroke=\"%s\" stroke-width=\"1.8\" stroke-dasharray=\"%s\"/>\n"
        "<text x=\"%.1f\" y=\"%.1f\">%s</text>\n",
        ex, ey, colour, dashes, ex + 27, ey + 4, words.c_str());
  };
  for (std::size_t i = 0; i < paths.size(); ++i) {
    switch (paths[i].path) {
      case DeformationPath::shear:
        entry(0, 1, colours[i], "", "shear: P_xy, s = 1 + gamma");
        break;
      case DeformationPath::across:
        entry(200, 1, colours[i], "", "across fibres");
        break;
      default:
        entry(90 * static_cast<double>(i), 0, colours[i], "", paths[i].name);
    }
  }
  entry(0, 2, "#444", "2 4", "several stretches negative");
  entry(200, 2, "#b07d2b", "5 3", "limits of the model");
  return out;
}

/// Those of the material that has most.
std::span<const PathInfo> all_paths(const std::vector<PlottedMaterial>& materials) {
  std::span<const PathInfo> most;
  for (const auto& plotted : materials) {
    const auto paths = paths_of(plotted.point.material);
    if (paths.size() > most.size()) most = paths;
  }
  return most;
}

}  // namespace

std::string stress_plot(const std::vector<PlottedMaterial>& materials, double from, double to) {
  const std::size_t columns = std::min<std::size_t>(materials.size(), 3);
  const std::size_t rows = (materials.size() + columns - 1) / columns;
  const double width = panel_width * static_cast<double>(columns);
  const double below = panel_height * static_cast<double>(rows);
  std::string out = formatted(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" font-family=\"sans-serif\" "
      "font-size=\"11\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
      width, below + legend_height + 14);
  for (std::size_t i = 0; i < materials.size(); ++i)
    out += panel_of(materials[i], i, panel_width * static_cast<double>(i % columns),
                    panel_height * static_cast<double>(i / columns), from, to);
  out += formatted("<text x=\"%g\" y=\"%g\">first Piola-Kirchhoff stress [Pa] over stretch s</text>\n", left,
                   below + 4);
  return out + legend(below + 14, all_paths(materials)) + "</svg>\n";
}

}  // namespace evert
