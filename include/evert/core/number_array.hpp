#pragma once
#include "evert/core/aligned.hpp"

#include <cstddef>
#include <variant>

namespace evert {

/// How element data are kept and computed with.
enum class Precision {
  full,   ///< all in double
  mixed,  ///< in float, between nodal values in double
};

/// An array whose numbers are doubles or, in mixed precision, floats.
class NumberArray {
 public:
  NumberArray() = default;
  /// Zeros.
  NumberArray(Precision precision, std::size_t size) {
    if (precision == Precision::mixed) {
      numbers_.emplace<AlignedVector<float>>(size, 0.0F);
    } else {
      numbers_.emplace<AlignedVector<double>>(size, 0.0);
    }
  }

  [[nodiscard]] std::size_t size() const {
    return std::visit([](const auto& numbers) { return numbers.size(); }, numbers_);
  }
  [[nodiscard]] std::size_t bytes() const {
    return std::visit([](const auto& numbers) { return numbers.capacity() * sizeof(numbers[0]); }, numbers_);
  }

  [[nodiscard]] double operator[](std::size_t i) const {
    return std::visit([i](const auto& numbers) { return static_cast<double>(numbers[i]); }, numbers_);
  }
  /// Rounded to what the array holds.
  void set(std::size_t i, double value) {
    std::visit(
        [=]<class Vector>(Vector& numbers) { numbers[i] = static_cast<typename Vector::value_type>(value); },
        numbers_);
  }

  /// For whoever knows which they are.
  [[nodiscard]] const void* data() const {
    return std::visit([](const auto& numbers) -> const void* { return numbers.data(); }, numbers_);
  }
  [[nodiscard]] void* data() {
    return std::visit([](auto& numbers) -> void* { return numbers.data(); }, numbers_);
  }

 private:
  std::variant<AlignedVector<double>, AlignedVector<float>> numbers_;
};

}  // namespace evert
