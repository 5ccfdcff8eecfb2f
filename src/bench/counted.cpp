#include "counted.hpp"

namespace evert::bench {

OperationLog& Counted::so_far() {
  static OperationLog all;
  return all;
}

Counted Counted::load(const double* from) noexcept {
  so_far().read.insert(from);
  return *from;
}

Counted Counted::load(const float* from) { return static_cast<double>(*from); }

void Counted::store(double* to) const noexcept {
  so_far().written.insert(to);
  *to = value_;
}

Counted log(const Counted& x) noexcept {
  constexpr double operations_of_log = 33;
  Counted::so_far().flops += operations_of_log;
  Counted::so_far().divisions += 1;
  return std::log(x.value());
}

Counted exp(const Counted& x) noexcept {
  constexpr double operations_of_exp = 34;
  Counted::so_far().flops += operations_of_exp;
  return std::exp(x.value());
}

Counted Counted::counted(double value) noexcept {
  so_far().flops += 1;
  return value;
}

Counted Counted::divided(double value) noexcept {
  so_far().divisions += 1;
  return counted(value);
}

}  // namespace evert::bench
