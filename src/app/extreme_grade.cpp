#include "evert/app/extreme_trial.hpp"
#include "evert/core/formatted.hpp"

#include <cmath>
#include <cstdlib>

namespace evert {
namespace {

/// One sentence that is more than a word, and no number that is none.
bool is_clear(const std::string& message) {
  constexpr std::size_t shortest = 20;
  return message.size() >= shortest && message.find('\n') == std::string::npos &&
         message.find(" nan") == std::string::npos && message.find("-nan") == std::string::npos;
}

}  // namespace

const char* name_of(Grade grade) {
  switch (grade) {
    case Grade::recovered:
      return "recovered";
    case Grade::stable:
      return "stable";
    case Grade::failed:
      return "failed";
    case Grade::defect:
      break;
  }
  return "DEFECT";
}

Verdict graded(const TrialEnd& end) {
  if (!end.error.empty())
    return is_clear(end.error) ? Verdict{Grade::failed, end.error}
                               : Verdict{Grade::defect, "the message is not clear: " + end.error};
  if (end.timed_out) return {Grade::defect, "does not end within the time limit"};
  if (!end.finite) return {Grade::defect, "ends with something that is not finite"};
  if (end.inverted_points == 0 && end.shape_error <= recovered_within) return {Grade::recovered, ""};
  if (!(end.energy_gain <= end.stable_gain))
    return {Grade::defect, formatted("gained %.3g of its energy", end.energy_gain)};
  return {Grade::stable, formatted("%lld points inverted, %.2g of its size from the rest shape",
                                   end.inverted_points, end.shape_error)};
}

std::optional<double> suggested_step(const std::string& message) {
  const std::string before = "try an integrator.time_step of ";
  const auto at = message.find(before);
  if (at == std::string::npos) return std::nullopt;
  const double step = std::strtod(message.c_str() + at + before.size(), nullptr);
  return step > 0 ? std::optional(step) : std::nullopt;
}

}  // namespace evert
