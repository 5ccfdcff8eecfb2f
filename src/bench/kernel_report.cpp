#include "evert/bench/kernel_report.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/formatted.hpp"
#include "evert/forces/kernels/cpu_level.hpp"
#include "evert/io/json_text.hpp"

#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <utility>

namespace evert::bench {
namespace {

std::string machine_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text.data();
}

/// In millions, to three digits or a little more.
std::string number_text(double rate) {
  const double millions = rate / 1e6;
  return formatted(millions < 10 ? "%.2f" : millions < 1000 ? "%.1f" : "%.0f", millions);
}

/// What the rate is a multiple of.
std::string multiple_text(const KernelRate& kernel) {
  if (kernel.of_naive > 0) return formatted("%5.1f x naive", kernel.of_naive);
  if (kernel.of_baij > 0) return formatted("%5.1f x BAIJ", kernel.of_baij);
  return "";
}

std::string cost_text(const KernelCost& cost) {
  if (cost.flops == 0) return "";
  return formatted("%7.0f%6.0f%7.0f", cost.flops, cost.divisions, cost.bytes);
}

std::string ceiling_text(const KernelRate& kernel) {
  if (kernel.of_ceiling == 0) return "";
  return formatted("%4.0f %% of %s", 100 * kernel.of_ceiling, kernel.ceiling.c_str());
}

std::string line(const std::string& title, const Rate& rate, const std::string& unit,
                 const std::string& rest) {
  return formatted("%-29s%8s%8s  %-9s%s", title.c_str(), number_text(rate.best).c_str(),
                   number_text(rate.median).c_str(), unit.c_str(), rest.c_str());
}

/// Without the blanks of its last columns.
void put(std::ostream& out, std::string text) {
  text.erase(text.find_last_not_of(' ') + 1);
  out << text << '\n';
}

JsonValue rate_value(const Rate& rate, double unit) {
  return JsonValue::object({{"best", rate.best / unit}, {"median", rate.median / unit}});
}

/// An object with a member for each size.
template <class ValueOf>
JsonValue by_size(const KernelReport& report, ValueOf&& value_of) {
  std::vector<std::pair<std::string, JsonValue>> members;
  for (const auto& size : report.sizes) members.emplace_back(size.size, value_of(size));
  return JsonValue::object(members);
}

/// An object with a member for each kernel of which there is something to tell.
JsonValue by_kernel(const KernelSizeReport& size, double KernelRate::*number) {
  std::vector<std::pair<std::string, JsonValue>> members;
  for (const auto& kernel : size.kernels)
    if (kernel.*number > 0) members.emplace_back(kernel.key, kernel.*number);
  return JsonValue::object(members);
}

JsonValue filtered_costs(const KernelSizeReport& size) {
  std::vector<std::pair<std::string, JsonValue>> members;
  for (const auto& cost : size.filtered_costs) members.emplace_back(cost.model, cost.of_unfiltered);
  return JsonValue::object(members);
}

JsonValue costs(const KernelSizeReport& size) {
  std::vector<std::pair<std::string, JsonValue>> members;
  for (const auto& kernel : size.kernels)
    if (kernel.cost.flops > 0)
      members.emplace_back(kernel.key, JsonValue::object({{"flops", kernel.cost.flops},
                                                          {"divisions", kernel.cost.divisions},
                                                          {"bytes", kernel.cost.bytes}}));
  return JsonValue::object(members);
}

}  // namespace

Setting current_setting(MPI_Comm comm) {
  return {size_of(comm), machine_model(), std::string(kernels::chosen_cpu_level().name), utc_now()};
}

void print_head(const Setting& setting, std::ostream& out) {
  out << "evert bench kernels: " << setting.ranks << (setting.ranks == 1 ? " rank" : " ranks") << " on "
      << setting.machine << ", kernels " << setting.cpu_level << ", " << setting.date << '\n';
}

void print_table(const KernelSizeReport& report, std::ostream& out) {
  put(out, formatted("\n%s: %lld tets (%.1f %% inverted), %lld hexes; %d samples each", report.size.c_str(),
                     static_cast<long long>(report.tets), 100 * report.inverted,
                     static_cast<long long>(report.hexes), report.rounds));
  put(out, formatted("%-29s%8s%8s  %-9s%-15s%7s%6s%7s   %s", "", "best", "median", "", "  multiple", "flop",
                     "div", "byte", "ceiling"));
  for (const auto& kernel : report.kernels)
    put(out, line(kernel.title, kernel.rate, kernel.unit,
                  formatted("%-15s%-20s%s", multiple_text(kernel).c_str(), cost_text(kernel.cost).c_str(),
                            ceiling_text(kernel).c_str())));
  for (const auto& [model, of_unfiltered] : report.filtered_costs)
    put(out, formatted("a filtered tet4 costs %.2f unfiltered ones: %s", of_unfiltered, model.c_str()));
  const auto ceiling = [&](const char* title, const Rate& rate, const char* unit) {
    put(out, line(title, {rate.best / 1e3, rate.median / 1e3}, unit, ""));
  };
  ceiling("ceiling: multiply, add", report.flops, "Gflop/s");
  ceiling("ceiling: divide, root", report.divisions, "Gdiv/s");
  ceiling("ceiling: triad", report.bytes, "GB/s");
}

std::string json_text(const KernelReport& report) {
  std::vector<std::pair<std::string, JsonValue>> members{
      {"date", report.setting.date},
      {"machine", report.setting.machine},
      {"cpu_level", report.setting.cpu_level},
      {"ranks", report.setting.ranks},
      {"sizes", by_size(report, [](const KernelSizeReport& size) {
         return JsonValue::object({{"tets", size.tets},
                                   {"hexes", size.hexes},
                                   {"inverted_share", size.inverted},
                                   {"samples", size.rounds}});
       })}};
  if (!report.sizes.empty()) {
    const auto& kernels = report.sizes.front().kernels;
    for (std::size_t i = 0; i < kernels.size(); ++i)
      members.emplace_back(kernels[i].key, by_size(report, [&](const KernelSizeReport& size) {
                             return rate_value(size.kernels[i].rate, 1e6);
                           }));
  }
  const auto add = [&](const char* key, auto&& value_of) {
    members.emplace_back(key, by_size(report, value_of));
  };
  add("cost_of_item", [](const auto& size) { return costs(size); });
  add("multiply_add_gflops", [](const KernelSizeReport& size) { return rate_value(size.flops, 1e9); });
  add("division_gps", [](const KernelSizeReport& size) { return rate_value(size.divisions, 1e9); });
  add("triad_gbs", [](const KernelSizeReport& size) { return rate_value(size.bytes, 1e9); });
  add("multiple_of_naive", [](const auto& size) { return by_kernel(size, &KernelRate::of_naive); });
  add("multiple_of_baij", [](const auto& size) { return by_kernel(size, &KernelRate::of_baij); });
  add("filtered_cost", [](const auto& size) { return filtered_costs(size); });
  add("share_of_ceiling", [](const auto& size) { return by_kernel(size, &KernelRate::of_ceiling); });
  return JsonValue::object(members).text() + '\n';
}

}  // namespace evert::bench
