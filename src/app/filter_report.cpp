#include "filter_report.hpp"

#include "evert/core/formatted.hpp"

#include <array>
#include <cmath>

namespace evert {
namespace {

std::string candidate_line(const FilterCandidate& candidate, const ModalFilterOptions& options) {
  const auto step = formatted("  %g s, %.3g times the body's own: ", candidate.time_step, candidate.multiple);
  if (!candidate.within_reach) return step + "every element of a material would be softened";
  const auto cost =
      formatted("%lld filtered, %.3g %% of the mass of a material, %.2f times as fast",
                static_cast<long long>(candidate.filtered), 100 * candidate.softened, candidate.gain);
  return step + cost + (candidate.softens_too_much(options) ? ", too much softened" : "");
}

std::string why_not(const AutomaticStep& automatic, const ModalFilterOptions& options) {
  if (options.fixed_time_step > 0)
    return formatted("the body takes the fixed step by itself, its own is %g s", automatic.own_step);
  if (!std::isfinite(automatic.own_step)) return "nothing limits the step";
  if (options.constraints == FilterConstraints::compliant) return "no step pays";
  return formatted("no step pays that softens at most %g %% of the mass (filter.most_softened)",
                   100 * options.most_softened);
}

}  // namespace

std::vector<std::string> filter_lines(MPI_Comm comm, const ModalFilter& filter) {
  std::array<GlobalIndex, 2> counts{filter.filtered_cells(),
                                    static_cast<GlobalIndex>(filter.clamps().size())};
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), 2, MPI_INT64_T, MPI_SUM, comm);
  const auto& options = filter.options();
  const auto& automatic = filter.automatic();
  const std::string by = automatic ? "auto: " : "";
  if (automatic && !std::isfinite(automatic->time_step)) {
    std::vector<std::string> lines{by + "nothing is filtered: " + why_not(*automatic, options)};
    for (const auto& candidate : automatic->candidates) lines.push_back(candidate_line(candidate, options));
    return lines;
  }
  std::vector<std::string> lines{
      by +
      formatted("%lld of %lld tet4 are filtered for steps of %g s with a safety of %g, selection ",
                static_cast<long long>(counts[0]), static_cast<long long>(counts[1]), filter.time_step(),
                options.safety) +
      std::string(name_of(options.selection)) + ", constraints " + std::string(name_of(options.constraints))};
  if (automatic)
    for (const auto& candidate : automatic->candidates) lines.push_back(candidate_line(candidate, options));
  return lines;
}

}  // namespace evert
