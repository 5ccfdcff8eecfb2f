#include "evert/trade/measurement.hpp"

#include "evert/core/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace evert::trade {
namespace {

/// False when `text` is not three finite numbers with commas between.
bool read_position(std::string_view text, Vec3d& position) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [next, error] = std::from_chars(at, end, position[i]);
    if (error != std::errc{} || !std::isfinite(position[i])) return false;
    if (i == 2) return next == end;
    if (next == end || *next != ',') return false;
    at = next + 1;
  }
  return false;
}

}  // namespace

const char* name_of(Fate fate) {
  switch (fate) {
    case Fate::finished:
      return "finished";
    case Fate::unstable:
      return "unstable";
    case Fate::too_slow:
      return "too slow";
    case Fate::refused:
      break;
  }
  return "refused";
}

double RunRecord::cost() const {
  if (cpu_seconds.empty() || reached <= 0) return 0;
  return *std::ranges::min_element(cpu_seconds) / reached;
}

Probe parse_probe(const std::string& text, const std::vector<std::string>& bodies) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw UserError("-probe " + text + ": must be name=x,y,z or name=body:x,y,z");
  Probe probe{text.substr(0, equals), {bodies.front(), {}}};
  auto place = text.substr(equals + 1);
  if (const auto colon = place.find(':'); colon != std::string::npos) {
    probe.point.body = place.substr(0, colon);
    place = place.substr(colon + 1);
  }
  if (std::ranges::find(bodies, probe.point.body) == bodies.end())
    throw UserError("-probe " + text + ": there is no body '" + probe.point.body + "': must be " +
                    list_of(bodies) + did_you_mean(probe.point.body, bodies));
  if (!read_position(place, probe.point.position))
    throw UserError("-probe " + text + ": must end with three numbers [m] like 1,0,0.5");
  return probe;
}

}  // namespace evert::trade
