#include "stability_report.hpp"

#include "evert/core/formatted.hpp"
#include "evert/filter/collatz_wielandt.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace evert {
namespace {

constexpr std::size_t most_listed = 10;

std::string step_text(double squared_frequency) {
  const double step = step_limit(squared_frequency);
  return std::isinf(step) ? "no limit" : formatted("%.5g ms", 1e3 * step);
}

/// Only what a class is defined for has one.
std::string shape_text(const ElementRecord& element) {
  return std::string(element.type == CellType::tet4 ? name_of(element.shape) : name_of(element.type));
}

std::string energy_text(double share) { return formatted("%5.1f %%", 100 * share); }

void write_bounds(const StabilityFindings& found, std::ostream& out) {
  struct Row {
    const char* name;
    double squared_frequency;
    const char* kind;
  };
  const std::array rows{
      Row{"true limit", found.truth, ""},
      Row{"Collatz-Wielandt, whole body", found.collatz_wielandt, "bound"},
      Row{"elements, masses split as auto does", found.balanced, "bound"},
      Row{"elements, masses of their nodes, (8)", found.eq8, "bound"},
      Row{"elements, their own masses, (9)", found.eq9, "bound"},
      Row{"20 steps of Lanczos", found.lanczos, "estimate"},
  };
  out << "  bound                                 step          of the true limit\n";
  for (const auto& row : rows) {
    const double ratio = std::sqrt(found.truth / row.squared_frequency);
    out << formatted("  %-37s %-13s ", row.name, step_text(row.squared_frequency).c_str())
        << (std::isfinite(ratio) ? formatted("%-8.4f", ratio) : "-       ") << row.kind << '\n';
  }
}

/// Of all elements of one shape.
struct ShapeSummary {
  GlobalIndex count = 0;
  double fastest = 0;
  double energy = 0;
};

void write_shapes(const StabilityFindings& found, std::ostream& out) {
  std::map<std::string, ShapeSummary> shapes;
  for (const auto& element : found.elements) {
    auto& shape = shapes[shape_text(element)];
    ++shape.count;
    shape.fastest = std::max(shape.fastest, element.own);
    shape.energy += element.energy;
  }
  out << "  shape          elements  shortest step (9)  of the energy of the fastest vibration\n";
  for (const auto& [name, shape] : shapes)
    out << formatted("  %-13s %9lld  %-17s ", name.c_str(), static_cast<long long>(shape.count),
                     step_text(shape.fastest).c_str())
        << energy_text(shape.energy) << '\n';
}

/// Bins of a factor of two, up from the shortest step; the last takes all that are longer.
void write_histogram(const StabilityFindings& found, std::ostream& out) {
  constexpr std::size_t most_bins = 12;
  constexpr double width = 40;
  if (!(found.eq9 > 0)) return;
  const double shortest = step_limit(found.eq9);
  std::array<GlobalIndex, most_bins> counts{};
  for (const auto& element : found.elements) {
    const double factor = std::log2(step_limit(element.own) / shortest);
    const double bin = std::clamp(std::floor(factor), 0.0, most_bins - 1.0);
    ++counts[static_cast<std::size_t>(bin)];
  }
  const auto most = static_cast<double>(*std::ranges::max_element(counts));
  out << "  steps of the elements by themselves, (9)\n";
  for (std::size_t bin = 0; bin < most_bins; ++bin) {
    const auto count = counts[bin];
    if (count == 0) continue;
    const auto stars = static_cast<std::size_t>(std::ceil(width * static_cast<double>(count) / most));
    out << formatted("  from %-12s %9lld  ",
                     formatted("%.4g ms", 1e3 * shortest * std::exp2(static_cast<double>(bin))).c_str(),
                     static_cast<long long>(count))
        << std::string(stars, '*') << '\n';
  }
}

/// In how few elements nearly all of the fastest vibration is.
void write_concentration(const StabilityFindings& found, std::ostream& out) {
  constexpr double nearly_all = 0.9;
  std::vector<double> energies;
  for (const auto& element : found.elements) energies.push_back(element.energy);
  std::ranges::sort(energies, std::greater());
  double sum = 0;
  std::size_t count = 0;
  while (count < energies.size() && sum < nearly_all) sum += energies[count++];
  out << formatted("  %zu of %zu elements hold 90 %% of the energy of the fastest vibration, %.5g Hz\n",
                   count, energies.size(), std::sqrt(found.truth) / 6.283185307179586);
}

void write_guilty(const StabilityFindings& found, const std::vector<std::string>& regions,
                  std::ostream& out) {
  auto worst = found.elements;
  const auto listed = std::min(worst.size(), most_listed);
  std::ranges::partial_sort(
      worst, worst.begin() + static_cast<std::ptrdiff_t>(listed),
      [](const auto& a, const auto& b) { return a.own != b.own ? a.own > b.own : a.cell < b.cell; });
  out << "  element    shape        step (9)      energy   in\n";
  for (std::size_t i = 0; i < listed; ++i)
    out << formatted("  %-10lld %-12s %-13s ", static_cast<long long>(worst[i].cell),
                     shape_text(worst[i]).c_str(), step_text(worst[i].own).c_str())
        << energy_text(worst[i].energy) << "  " << regions[static_cast<std::size_t>(worst[i].region)] << '\n';
}

}  // namespace

void write_stability(const StabilityFindings& findings, const std::string& state,
                     const std::vector<std::string>& regions, std::ostream& out) {
  out << state << ": steps that explicit elastic forces are stable with, undamped\n";
  write_bounds(findings, out);
  out << '\n';
  write_shapes(findings, out);
  out << '\n';
  write_histogram(findings, out);
  out << '\n';
  write_guilty(findings, regions, out);
  if (findings.truth > 0) write_concentration(findings, out);
}

void write_element_table(const StabilityFindings& findings, const std::vector<std::string>& regions,
                         std::ostream& out) {
  out << "element,region,type,shape,step_own_masses_s,step_nodal_masses_s,energy_share\n";
  for (const auto& element : findings.elements)
    out << element.cell << ',' << regions[static_cast<std::size_t>(element.region)] << ','
        << name_of(element.type) << ',' << (element.type == CellType::tet4 ? name_of(element.shape) : "")
        << formatted(",%.9g,%.9g,%.6g\n", step_limit(element.own), step_limit(element.nodal), element.energy);
}

}  // namespace evert
