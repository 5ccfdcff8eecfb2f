#include "evert/sim/growth_watch.hpp"

#include <algorithm>

namespace evert {

GrowthWatch::Sums GrowthWatch::look(std::span<const double> masses, std::span<const double> velocities) {
  Sums sums;
  for (std::size_t node = 0; node < masses.size(); ++node) {
    const double* v = &velocities[3 * node];
    float* before = &before_[3 * node];
    double turned = 0, square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      turned += v[k] * static_cast<double>(before[k]);
      square += v[k] * v[k];
      before[k] = static_cast<float>(v[k]);
    }
    sums.turned += masses[node] * turned;
    sums.square += masses[node] * square;
  }
  return sums;
}

void GrowthWatch::judge(const Sums& all) {
  if (all.turned < 0 && square_ > 0 && all.square > square_) {
    all_growth_ *= all.square / square_;
    // The first turn tells nothing: the velocity before may have been next to nothing by chance.
    if (turns_++ > 0) {
      growth_ *= all.square / square_;
      largest_ = std::max(largest_, all.square / square_);
    }
  } else {
    forget();
  }
  square_ = all.square;
}

}  // namespace evert
