#pragma once
#include "evert/math/pack.hpp"

#include "level_kernels.hpp"

namespace evert::test {

/// One operation on x and y, as a number: a comparison gives 1 or 0.
template <class T>
EVERT_ALWAYS_INLINE T apply(Operation operation, const T& x, const T& y) {
  const auto truth = [](const mask_t<T>& mask) { return select(mask, T(1), T(0)); };
  T z = x;
  switch (operation) {
    case Operation::add:
      return x + y;
    case Operation::subtract:
      return x - y;
    case Operation::multiply:
      return x * y;
    case Operation::divide:
      return x / y;
    case Operation::negate:
      return -x;
    case Operation::add_to:
      return z += y;
    case Operation::subtract_from:
      return z -= y;
    case Operation::multiply_by:
      return z *= y;
    case Operation::divide_by:
      return z /= y;
    case Operation::less:
      return truth(x < y);
    case Operation::greater:
      return truth(x > y);
    case Operation::less_equal:
      return truth(x <= y);
    case Operation::greater_equal:
      return truth(x >= y);
    case Operation::equal:
      return truth(x == y);
    case Operation::not_equal:
      return truth(x != y);
    case Operation::square_root:
      return sqrt(x);
    case Operation::absolute:
      return abs(x);
    case Operation::minimum:
      return min(x, y);
    case Operation::maximum:
      return max(x, y);
    case Operation::copy_sign:
      return copysign(x, y);
    case Operation::times_sign:
      return multiply_sign(x, y);
    case Operation::logarithm:
      return log(x);
    case Operation::exponential:
      return exp(x);
    case Operation::power_of_two:
      return floor_power_of_two(x);
    case Operation::broadcast:
      return splat<T>(3);
    case Operation::lane_sum_of_generated:
      return generate<T>([&](std::size_t i) { return lane(x, i) + lane(y, i); });
    case Operation::count:
      break;
  }
  return x;
}

}  // namespace evert::test
