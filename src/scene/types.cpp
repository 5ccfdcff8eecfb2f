#include "tables.hpp"
#include <algorithm>
#include <cmath>

namespace evert {

using namespace schema;

Type<Vec3d> vector3(const std::string& unit, const Range& range) {
  const auto numbers = array_of<3>(number(unit, range), "numbers");
  return {.info = numbers.info,
          .read = [numbers](const Value& value,
                            const std::string& path) { return Vec3d{numbers.read(value, path)}; },
          .write = [numbers](const Vec3d& value) { return numbers.write(value.components); }};
}

Type<Vec3d> direction() {
  auto type = vector3("-");
  type.info.range = "not all zero; the length does not matter";
  type.read = [numbers = type.read](const Value& value, const std::string& path) {
    Vec3d v = numbers(value, path);
    const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    if (largest == 0) fail(value, path, "must not be [0, 0, 0]: it is a direction");
    v = (1 / largest) * v;  // first, so that the squares neither overflow nor vanish
    return (1 / std::sqrt(dot(v, v))) * v;
  };
  return type;
}

Type<Vec3d> gravity_type() { return vector3("m/s^2"); }

Type<double> friction_type() { return number("-", at_least(0)); }

void expect_ordered(const Vec3d& min, const Vec3d& max, const Value& map, const std::string& path) {
  for (std::size_t i = 0; i < 3; ++i)
    if (min[i] > max[i])
      fail(map, join(path, "min"), "must not exceed max, but does along " + std::string(1, "xyz"[i]));
}

}  // namespace evert
