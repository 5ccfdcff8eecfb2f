#include "evert/bench/elements.hpp"
#include "evert/core/formatted.hpp"
#include "evert/io/json_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace evert::bench {
namespace {

constexpr std::array colours{"#2d6ca8", "#c8362b", "#e08a1e", "#3f8f5b", "#8a5fb0", "#20242a"};
constexpr double width = 640, height = 420, left = 64, right = 100, top = 16, bottom = 48;

/// Axes of powers of ten around all results.
class Page {
 public:
  explicit Page(const ElementReport& report) {
    for (const auto& result : report.results) {
      include(std::log10(result.cost()), cost_);
      include(std::log10(std::abs(result.error(report.reference))), error_);
    }
    for (auto* range : {&cost_, &error_}) *range = {std::floor((*range)[0]), std::ceil((*range)[1])};
  }
  [[nodiscard]] double x(double cost) const { return at_x(std::log10(cost)); }
  [[nodiscard]] double y(double error) const { return at_y(std::log10(std::abs(error))); }

  [[nodiscard]] std::string axes() const {
    std::string out;
    for (double power = cost_[0]; power <= cost_[1]; ++power) {
      out +=
          formatted("<path d=\"M%.1f,%.1fV%.1f\" stroke=\"#e3e6ea\"/>\n", at_x(power), top, height - bottom);
      out += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%g</text>\n", at_x(power),
                       height - bottom + 16, std::pow(10, power));
    }
    for (double power = error_[0]; power <= error_[1]; ++power) {
      out +=
          formatted("<path d=\"M%.1f,%.1fH%.1f\" stroke=\"#e3e6ea\"/>\n", left, at_y(power), width - right);
      out += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%g %%</text>\n", left - 6,
                       at_y(power) + 4, 100 * std::pow(10, power));
    }
    out += formatted(
        "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">processor time of the forces for a "
        "simulated second [s]</text>\n",
        (left + width - right) / 2, height - 10);
    return out + formatted(
                     "<text x=\"14\" y=\"%.1f\" text-anchor=\"middle\" transform=\"rotate(-90 14 "
                     "%.1f)\">error of the tip deflection</text>\n",
                     (top + height - bottom) / 2, (top + height - bottom) / 2);
  }

 private:
  static void include(double value, std::array<double, 2>& range) {
    range = {std::min(range[0], value), std::max(range[1], value)};
  }
  [[nodiscard]] double at_x(double power) const {
    return left + (width - left - right) * (power - cost_[0]) / std::max(cost_[1] - cost_[0], 1.0);
  }
  [[nodiscard]] double at_y(double power) const {
    return height - bottom -
           (height - top - bottom) * (power - error_[0]) / std::max(error_[1] - error_[0], 1.0);
  }
  std::array<double, 2> cost_{1e9, -1e9}, error_{1e9, -1e9};
};

}  // namespace

void print_table(const ElementReport& report, std::ostream& out) {
  out << "evert bench elements: " << report.setting.ranks << (report.setting.ranks == 1 ? " rank" : " ranks")
      << " on " << report.setting.machine << ", kernels " << report.setting.cpu_level << ", "
      << report.setting.date << "\n\n";
  out << formatted(
      "cantilever of %g m, %g m square, E %g Pa, nu %g; tip deflection of tet10, %d across: %.5g "
      "m, Timoshenko: %.5g m\n\n",
      report.beam.length, report.beam.height, report.beam.youngs_modulus, report.beam.poissons_ratio,
      report.reference_across, report.reference, report.theory);
  out << formatted("%-8s%7s%9s%9s%8s%10s%11s%10s%13s%10s\n", "", "across", "cells", "nodes", "points",
                   "force", "force", "stable", "force time", "error");
  out << formatted("%-8s%7s%9s%9s%8s%10s%11s%10s%13s%10s\n", "", "", "", "", "a node", "ns a node",
                   "us a step", "step [us]", "s a second", "of tip");
  for (const auto& r : report.results)
    out << formatted("%-8s%7d%9lld%9lld%8.1f%10.1f%11.1f%10.1f%13.4f%8.2f %%\n", r.kind.c_str(), r.across,
                     static_cast<long long>(r.cells), static_cast<long long>(r.nodes),
                     static_cast<double>(r.points) / static_cast<double>(r.nodes),
                     1e9 * r.force_seconds / static_cast<double>(r.nodes), 1e6 * r.force_seconds,
                     1e6 * r.stable_step, r.cost(), 100 * r.error(report.reference));
  out << formatted("\ntip deflection over that of tet10, %d across, at Poisson's ratio; %d across\n%-8s",
                   report.reference_across, report.locking_across, "");
  for (const auto& kind : element_kinds()) out << formatted("%9s", kind.name.c_str());
  out << '\n';
  for (const auto& row : report.locking) {
    out << formatted("%-8g", row.poissons_ratio);
    for (const double deflection : row.deflections) out << formatted("%9.3f", deflection / row.reference);
    out << '\n';
  }
}

std::string json_text(const ElementReport& report) {
  std::vector<JsonValue> results, locking;
  for (const auto& r : report.results)
    results.push_back(JsonValue::object({{"kind", r.kind},
                                         {"across", r.across},
                                         {"cells", r.cells},
                                         {"nodes", r.nodes},
                                         {"points", r.points},
                                         {"force_seconds", r.force_seconds},
                                         {"stable_step", r.stable_step},
                                         {"tip_deflection", r.deflection},
                                         {"error", r.error(report.reference)}}));
  for (const auto& row : report.locking) {
    std::vector<std::pair<std::string, JsonValue>> members{{"poissons_ratio", row.poissons_ratio}};
    for (std::size_t k = 0; k < row.deflections.size(); ++k)
      members.emplace_back(element_kinds()[k].name, row.deflections[k] / row.reference);
    locking.push_back(JsonValue::object(members));
  }
  return JsonValue::object({{"date", report.setting.date},
                            {"machine", report.setting.machine},
                            {"cpu_level", report.setting.cpu_level},
                            {"ranks", report.setting.ranks},
                            {"reference_deflection", report.reference},
                            {"timoshenko_deflection", report.theory},
                            {"elements", JsonValue::list(results)},
                            {"locking", JsonValue::list(locking)}})
             .text() +
         '\n';
}

std::string svg_text(const ElementReport& report) {
  const Page page(report);
  std::string out = formatted(
                        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" "
                        "font-family=\"sans-serif\" font-size=\"12\" fill=\"#20242a\">\n"
                        "<rect width=\"%g\" height=\"%g\" fill=\"white\"/>\n",
                        width, height, width, height) +
                    page.axes();
  for (std::size_t k = 0; k < element_kinds().size(); ++k) {
    const auto& name = element_kinds()[k].name;
    std::string path, marks;
    double x = 0, y = 0;
    for (const auto& r : report.results) {
      if (r.kind != name) continue;
      x = page.x(r.cost());
      y = page.y(r.error(report.reference));
      path += formatted("%s%.1f,%.1f", path.empty() ? "M" : "L", x, y);
      marks += formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", x, y, colours[k]);
    }
    out += formatted("<path d=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\"/>\n", path.c_str(),
                     colours[k]) +
           marks +
           formatted("<text x=\"%.1f\" y=\"%.1f\" fill=\"%s\">%s</text>\n", x + 7, y + 4, colours[k],
                     name.c_str());
  }
  return out + "</svg>\n";
}

}  // namespace evert::bench
