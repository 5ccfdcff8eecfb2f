#include "evert/trade/front.hpp"

#include "evert/core/formatted.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace evert::trade {
namespace {

std::string number(double value) { return std::isfinite(value) ? formatted("%.6g", value) : ""; }

/// Quotes as CSV has them.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

/// Position in the front, from 1; 0: not on it.
std::size_t rank_in(std::span<const std::size_t> front, std::size_t trial) {
  const auto found = std::ranges::find(front, trial);
  return found == front.end() ? 0 : static_cast<std::size_t>(found - front.begin()) + 1;
}

}  // namespace

std::string percent(double share) { return std::isfinite(share) ? formatted("%.3g %%", 100 * share) : "-"; }

std::vector<std::size_t> pareto_front(std::span<const Trial> trials) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < trials.size(); ++i)
    if (trials[i].usable() && std::isfinite(trials[i].errors.displacement)) order.push_back(i);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    if (trials[a].cost != trials[b].cost) return trials[a].cost < trials[b].cost;
    return trials[a].errors.displacement < trials[b].errors.displacement;
  });
  std::vector<std::size_t> front;
  constexpr double noticeable = 0.99;
  double least = std::numeric_limits<double>::infinity();
  for (const auto i : order) {
    if (!(trials[i].errors.displacement < noticeable * least)) continue;
    least = trials[i].errors.displacement;
    front.push_back(i);
  }
  return front;
}

std::string table_of(std::span<const Trial> trials, std::span<const std::size_t> front) {
  std::vector<std::size_t> order(trials.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return trials[i].cost; });
  std::size_t width = 7;
  for (const auto& trial : trials) width = std::max(width, trial.label.size());
  const int w = static_cast<int>(width);
  std::string out =
      formatted("front  %-*s  cost s/s    error   probes   energy   volume   frequency    steps  memory MB\n",
                w, "setting");
  for (const auto i : order) {
    const auto& trial = trials[i];
    const auto place = rank_in(front, i);
    out += formatted("%5s  %-*s  %8.3g", place > 0 ? std::to_string(place).c_str() : "", w,
                     trial.label.c_str(), trial.cost);
    if (!trial.usable()) {
      out +=
          formatted("  %s: ", name_of(trial.fate)) + trial.message.substr(0, trial.message.find(';')) + "\n";
      continue;
    }
    const auto& e = trial.errors;
    out += formatted("  %7s  %7s  %7s  %7s  %10s  %7.0f  %9.2f\n", percent(e.displacement).c_str(),
                     percent(e.probes).c_str(), percent(e.energy).c_str(), percent(e.volume).c_str(),
                     percent(e.frequency).c_str(), trial.steps, trial.memory / 1e6);
  }
  return out;
}

std::string csv_of(std::span<const Axis> axes, std::span<const Trial> trials,
                   std::span<const std::size_t> front) {
  std::string out;
  for (const auto& axis : axes) out += field(axis.key) + ",";
  out +=
      "fate,front,cost_s_per_s,displacement_error,probe_error,energy_error,volume_error,frequency_error,"
      "steps,"
      "nodes,memory_bytes,message\n";
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto& trial = trials[i];
    for (std::size_t a = 0; a < axes.size(); ++a) out += field(axes[a].values[trial.choice[a]]) + ",";
    const auto place = rank_in(front, i);
    out += std::string(name_of(trial.fate)) + "," + (place > 0 ? std::to_string(place) : "") + "," +
           number(trial.cost);
    const auto& e = trial.errors;
    for (const double error : {e.displacement, e.probes, e.energy, e.volume, e.frequency})
      out += "," + (trial.usable() ? number(error) : "");
    out +=
        formatted(",%.0f,%.0f,%.0f,", trial.steps, trial.nodes, trial.memory) + field(trial.message) + "\n";
  }
  return out;
}

}  // namespace evert::trade
