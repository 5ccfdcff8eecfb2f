#include "evert/app/observer.hpp"

#include <cmath>

namespace evert {
namespace {

// The run hits the product k·interval itself, so that only its rounding is to be forgiven.
constexpr double rounding = 1e-9;

}  // namespace

double Schedule::next_after(double time) const {
  return (std::floor(time / interval_ + rounding) + 1) * interval_;
}

bool Schedule::due(double time) const {
  const double count = time / interval_;
  return std::abs(count - std::round(count)) <= rounding;
}

}  // namespace evert
