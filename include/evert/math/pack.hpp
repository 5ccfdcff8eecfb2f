#pragma once
#include "evert/math/always_inline.hpp"

#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <experimental/simd>
#include <limits>
#include <type_traits>

/// A SIMD pack and, under the same names, the same operations on float, double and long double: a kernel is
/// one template on its scalar `T` and runs on any of them.
///
///   template <class T> T clamped(T x, T limit) { return select(x < limit, limit, x); }
///
/// The width follows the -march of the translation unit: `Pack` holds 2 doubles on x86-64-v2, 4 on v3, 8 on
/// v4. It is a different type on each, so templates over it never meet at link time (see always_inline.hpp).
namespace evert {

namespace stdx = std::experimental;

namespace detail {

/// The unsigned integer of a float's or double's width.
template <std::floating_point Scalar>
using BitsOf = std::conditional_t<sizeof(Scalar) == 8, std::uint64_t, std::uint32_t>;

}  // namespace detail

/// One truth value a lane: all bits of an integer of the lane's width, or none.
template <std::floating_point Scalar, std::size_t count>
class PackMask {
 public:
  using Word = std::make_signed_t<detail::BitsOf<Scalar>>;
  using Words [[gnu::vector_size(count * sizeof(Word))]] = Word;

  PackMask() = default;
  EVERT_ALWAYS_INLINE explicit PackMask(const Words& words) : words_(words) {}

  EVERT_ALWAYS_INLINE const Words& words() const { return words_; }

  // clang-format off
  EVERT_ALWAYS_INLINE friend PackMask operator&&(const PackMask& a, const PackMask& b) { return PackMask(a.words_ & b.words_); }
  EVERT_ALWAYS_INLINE friend PackMask operator||(const PackMask& a, const PackMask& b) { return PackMask(a.words_ | b.words_); }
  EVERT_ALWAYS_INLINE friend PackMask operator!(const PackMask& a) { return PackMask(~a.words_); }
  // clang-format on

 private:
  Words words_;
};

/// `count` numbers. Arithmetic is that of the compiler's own vectors, which cost it no more than a scalar;
/// std::experimental::simd does what they have no operator for. With its operators, five inlined calls deep
/// each, the kernels took 2.5 times as long to compile and ran 6 % slower: docs/design/cpu-levels.md.
template <std::floating_point Scalar_, std::size_t count>
class BasicPack {
 public:
  using Scalar = Scalar_;
  using Mask = PackMask<Scalar, count>;
  using Vector [[gnu::vector_size(count * sizeof(Scalar))]] = Scalar;
  using Bits [[gnu::vector_size(count * sizeof(Scalar))]] = detail::BitsOf<Scalar>;
  using Simd = stdx::simd<Scalar, stdx::simd_abi::deduce_t<Scalar, count>>;
  static constexpr std::size_t lanes = count;

  BasicPack() = default;
  // Copied by hand, not trivially: g++ 12 copies a trivially copyable struct of packs as one block of memory,
  // through the stack and with `rep movs`, which made a staged SVD 1.5 times slower.
  EVERT_ALWAYS_INLINE BasicPack(const BasicPack& other) : vector_(other.vector_) {}
  EVERT_ALWAYS_INLINE BasicPack& operator=(const BasicPack& other) {
    vector_ = other.vector_;
    return *this;
  }
  EVERT_ALWAYS_INLINE BasicPack(Scalar every_lane) : vector_(every_lane - Vector{}) {}  // − 0 keeps −0
  EVERT_ALWAYS_INLINE explicit BasicPack(const Vector& vector) : vector_(vector) {}
  EVERT_ALWAYS_INLINE explicit BasicPack(const Simd& simd) : vector_(std::bit_cast<Vector>(simd)) {}

  EVERT_ALWAYS_INLINE const Vector& vector() const { return vector_; }
  EVERT_ALWAYS_INLINE Simd simd() const { return std::bit_cast<Simd>(vector_); }

  /// The lanes as unsigned integers, and back.
  EVERT_ALWAYS_INLINE Bits bits() const { return std::bit_cast<Bits>(vector_); }
  EVERT_ALWAYS_INLINE static BasicPack from_bits(const Bits& bits) {
    return BasicPack(std::bit_cast<Vector>(bits));
  }

  /// From and to `count` numbers anywhere in memory.
  template <std::floating_point Number>
  EVERT_ALWAYS_INLINE static BasicPack load(const Number* from) {
    using Numbers [[gnu::vector_size(count * sizeof(Number))]] = Number;
    Numbers numbers;
    std::memcpy(&numbers, from, sizeof(numbers));
    return BasicPack(__builtin_convertvector(numbers, Vector));
  }
  EVERT_ALWAYS_INLINE void store(Scalar* to) const { std::memcpy(to, &vector_, sizeof(vector_)); }
  EVERT_ALWAYS_INLINE Scalar operator[](std::size_t lane) const { return vector_[lane]; }

  // clang-format off
  EVERT_ALWAYS_INLINE friend BasicPack operator+(const BasicPack& a, const BasicPack& b) { return BasicPack(a.vector_ + b.vector_); }
  EVERT_ALWAYS_INLINE friend BasicPack operator-(const BasicPack& a, const BasicPack& b) { return BasicPack(a.vector_ - b.vector_); }
  EVERT_ALWAYS_INLINE friend BasicPack operator*(const BasicPack& a, const BasicPack& b) { return BasicPack(a.vector_ * b.vector_); }
  EVERT_ALWAYS_INLINE friend BasicPack operator/(const BasicPack& a, const BasicPack& b) { return BasicPack(a.vector_ / b.vector_); }
  EVERT_ALWAYS_INLINE friend BasicPack operator-(const BasicPack& a) { return BasicPack(-a.vector_); }
  EVERT_ALWAYS_INLINE friend BasicPack& operator+=(BasicPack& a, const BasicPack& b) { return a = a + b; }
  EVERT_ALWAYS_INLINE friend BasicPack& operator-=(BasicPack& a, const BasicPack& b) { return a = a - b; }
  EVERT_ALWAYS_INLINE friend BasicPack& operator*=(BasicPack& a, const BasicPack& b) { return a = a * b; }
  EVERT_ALWAYS_INLINE friend BasicPack& operator/=(BasicPack& a, const BasicPack& b) { return a = a / b; }
  EVERT_ALWAYS_INLINE friend Mask operator<(const BasicPack& a, const BasicPack& b) { return Mask(a.vector_ < b.vector_); }
  EVERT_ALWAYS_INLINE friend Mask operator>(const BasicPack& a, const BasicPack& b) { return Mask(a.vector_ > b.vector_); }
  EVERT_ALWAYS_INLINE friend Mask operator<=(const BasicPack& a, const BasicPack& b) { return Mask(a.vector_ <= b.vector_); }
  EVERT_ALWAYS_INLINE friend Mask operator>=(const BasicPack& a, const BasicPack& b) { return Mask(a.vector_ >= b.vector_); }
  EVERT_ALWAYS_INLINE friend Mask operator==(const BasicPack& a, const BasicPack& b) { return Mask(a.vector_ == b.vector_); }
  EVERT_ALWAYS_INLINE friend Mask operator!=(const BasicPack& a, const BasicPack& b) { return Mask(a.vector_ != b.vector_); }
  // clang-format on

 private:
  Vector vector_;
};

using Pack = BasicPack<double, stdx::native_simd<double>::size()>;     ///< doubles of one register
using FloatPack = BasicPack<float, stdx::native_simd<float>::size()>;  ///< floats of one register

namespace detail {

template <class T>
struct PackTraits;

template <std::floating_point T>
struct PackTraits<T> {
  using Scalar = T;
  using Mask = bool;
  static constexpr std::size_t lanes = 1;
};

template <class Scalar_, std::size_t count>
struct PackTraits<BasicPack<Scalar_, count>> {
  using Scalar = Scalar_;
  using Mask = PackMask<Scalar, count>;
  static constexpr std::size_t lanes = count;
};

}  // namespace detail

/// Numbers in a T: 1 for a scalar.
template <class T>
inline constexpr std::size_t lanes_v = detail::PackTraits<T>::lanes;
/// What a lane of T holds: double for Pack and for double itself.
template <class T>
using scalar_t = typename detail::PackTraits<T>::Scalar;
/// What comparing two T gives: bool, or one truth value a lane.
template <class T>
using mask_t = typename detail::PackTraits<T>::Mask;

/// What the operations below accept.
template <class T>
concept Real = requires {
  typename detail::PackTraits<T>::Scalar;
};
template <class T>
concept RealPack = Real<T> && !std::floating_point<T>;

// --- lanes

/// The same number in every lane.
template <Real T>
EVERT_ALWAYS_INLINE T splat(scalar_t<T> every_lane) {
  return T(every_lane);
}

/// lanes_v<T> consecutive numbers; `from` needs no alignment beyond that of a scalar.
template <Real T>
EVERT_ALWAYS_INLINE T load(const scalar_t<T>* from) {
  if constexpr (std::floating_point<T>) {
    return *from;
  } else {
    return T::load(from);
  }
}

/// The same of floats, whatever T holds.
template <Real T>
EVERT_ALWAYS_INLINE T load_floats(const float* from) {
  if constexpr (std::floating_point<T>) {
    return T(*from);
  } else {
    return T::load(from);
  }
}

/// Writes lanes_v<T> consecutive numbers.
template <Real T>
EVERT_ALWAYS_INLINE void store(const T& x, scalar_t<T>* to) {
  if constexpr (std::floating_point<T>) {
    *to = x;
  } else {
    x.store(to);
  }
}

/// The number in one lane, 0 ≤ lane < lanes_v<T>.
template <Real T>
EVERT_ALWAYS_INLINE scalar_t<T> lane(const T& x, [[maybe_unused]] std::size_t index) {
  if constexpr (std::floating_point<T>) {
    return x;
  } else {
    return x[index];
  }
}

/// Lane i holds `number_of_lane(i)`; for gathers.
template <Real T, class Function>
EVERT_ALWAYS_INLINE T generate(Function&& number_of_lane) {
  scalar_t<T> numbers[lanes_v<T>];
  for (std::size_t i = 0; i < lanes_v<T>; ++i) numbers[i] = number_of_lane(i);
  return load<T>(numbers);
}

// --- masks

EVERT_ALWAYS_INLINE bool any(bool mask) { return mask; }
EVERT_ALWAYS_INLINE bool all(bool mask) { return mask; }
template <class Scalar, std::size_t count>
EVERT_ALWAYS_INLINE bool any(const PackMask<Scalar, count>& mask) {
  using Word = typename PackMask<Scalar, count>::Word;
  using Words = stdx::simd<Word, stdx::simd_abi::deduce_t<Word, count>>;
  return stdx::any_of(std::bit_cast<Words>(mask.words()) != 0);
}
template <class Scalar, std::size_t count>
EVERT_ALWAYS_INLINE bool all(const PackMask<Scalar, count>& mask) {
  return !any(!mask);
}

/// `a` where the mask holds, else `b`; both are evaluated.
template <Real T>
EVERT_ALWAYS_INLINE T select(const mask_t<T>& mask, const T& a, const T& b) {
  if constexpr (std::floating_point<T>) {
    return mask ? a : b;
  } else {
    return T(mask.words() ? a.vector() : b.vector());
  }
}

// --- arithmetic

template <Real T>
EVERT_ALWAYS_INLINE T sqrt(const T& x) {
  if constexpr (std::floating_point<T>) {
    return std::sqrt(x);
  } else {
    return T(stdx::sqrt(x.simd()));
  }
}

template <Real T>
EVERT_ALWAYS_INLINE T abs(const T& x) {
  if constexpr (std::floating_point<T>) {
    return std::abs(x);
  } else {
    return T::from_bits(x.bits() & ~T(-0.0).bits());
  }
}

// Not stdx::min and max: libstdc++ compiles them for finite numbers only, and they lose NaN.

/// The smaller; `a` where either is NaN, so put the guard last: min(x, limit) keeps a NaN in x.
template <Real T>
EVERT_ALWAYS_INLINE T min(const T& a, const std::type_identity_t<T>& b) {
  return select(b < a, b, a);
}

/// The larger; `a` where either is NaN, so put the guard last: max(x, limit) keeps a NaN in x.
template <Real T>
EVERT_ALWAYS_INLINE T max(const T& a, const std::type_identity_t<T>& b) {
  return select(b > a, b, a);
}

/// |magnitude| with the sign bit of `sign`.
template <Real T>
EVERT_ALWAYS_INLINE T copysign(const T& magnitude, const std::type_identity_t<T>& sign) {
  if constexpr (std::floating_point<T>) {
    return std::copysign(magnitude, sign);
  } else {
    const auto sign_bit = T(-0.0).bits();
    return T::from_bits((magnitude.bits() & ~sign_bit) | (sign.bits() & sign_bit));
  }
}

/// x with its sign flipped where the sign bit of `sign` is set (−0 counts as negative).
template <Real T>
EVERT_ALWAYS_INLINE T multiply_sign(const T& x, const std::type_identity_t<T>& sign) {
  if constexpr (std::floating_point<T>) {
    return std::signbit(sign) ? -x : x;
  } else {
    return T::from_bits(x.bits() ^ (sign.bits() & T(-0.0).bits()));
  }
}

// --- powers of two, logarithm and exponential

/// The largest power of two ≤ x, for positive normal x; NaN and ∞ give ∞.
template <Real T>
EVERT_ALWAYS_INLINE T floor_power_of_two(const T& x) {
  constexpr auto infinity = std::numeric_limits<scalar_t<T>>::infinity();
  if constexpr (RealPack<T>) {
    return T::from_bits(x.bits() & T(infinity).bits());
  } else if constexpr (std::same_as<T, long double>) {
    return std::isfinite(x) ? std::scalbn(1.0L, std::ilogb(x)) : infinity;
  } else {
    using Bits = detail::BitsOf<T>;
    return std::bit_cast<T>(std::bit_cast<Bits>(x) & std::bit_cast<Bits>(infinity));
  }
}

namespace detail {

/// Layout of a floating-point number, and the coefficients of fdlibm for log(1+f) = 2s + s·R(s²), with
/// s = f/(2+f): minimax on √½ ≤ 1+f ≤ √2, odd and even powers apart. ln 2 is split so that
/// exponent · ln2_high is exact.
template <class Scalar>
struct LogConstants;

template <>
struct LogConstants<double> {
  static constexpr int mantissa_bits = 52;
  static constexpr double bias = 1023;
  static constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  static constexpr double even[] = {6.666666666666735130e-01, 2.857142874366239149e-01,
                                    1.818357216161805012e-01, 1.479819860511658591e-01};
  static constexpr double odd[] = {3.999999999940941908e-01, 2.222219843214978396e-01,
                                   1.531383769920937332e-01};
};

template <>
struct LogConstants<float> {
  static constexpr int mantissa_bits = 23;
  static constexpr float bias = 127;
  static constexpr float ln2_high = 6.9313812256e-01F, ln2_low = 9.0580006145e-06F;
  static constexpr float even[] = {0.66666662693F, 0.28498786688F};
  static constexpr float odd[] = {0.40000972152F, 0.24279078841F};
};

/// c[0] + c[1] x + c[2] x² + …
template <class T, std::size_t count>
EVERT_ALWAYS_INLINE T polynomial(const scalar_t<T> (&c)[count], const T& x) {
  T sum = T(c[count - 1]);
  for (std::size_t i = count - 1; i > 0; --i) sum = sum * x + T(c[i - 1]);
  return sum;
}

template <class T>
struct MantissaExponent {
  T mantissa;  ///< in [√½, √2)
  T exponent;
};

/// x = mantissa · 2^exponent for positive normal x, by its bits.
template <RealPack T>
EVERT_ALWAYS_INLINE MantissaExponent<T> split_exponent(const T& x) {
  using Scalar = scalar_t<T>;
  using Constants = LogConstants<Scalar>;
  using Word = BitsOf<Scalar>;
  constexpr Word implicit_bit = Word{1} << Constants::mantissa_bits;
  constexpr auto implicit_bit_value = Scalar(implicit_bit);

  const auto bits = x.bits();
  const T one_to_two = T::from_bits((bits & (implicit_bit - 1)) | std::bit_cast<Word>(Scalar(1)));
  // An integer below 2^52 becomes a double by standing in the mantissa of 2^52, which is then subtracted.
  const T biased_exponent =
      T::from_bits((bits >> Constants::mantissa_bits) | std::bit_cast<Word>(implicit_bit_value)) -
      T(implicit_bit_value);
  const auto upper = one_to_two > T(Scalar(1.41421356237309504880L));
  return {select(upper, T(0.5) * one_to_two, one_to_two),
          biased_exponent - select(upper, T(Constants::bias - 1), T(Constants::bias))};
}

}  // namespace detail

/// Natural logarithm of a positive normal number, to about 1 ulp. NaN and ∞ give NaN in a pack; zero,
/// negative and subnormal numbers give a meaningless finite number there: clamp before.
template <Real T>
EVERT_ALWAYS_INLINE T log(const T& x) {
  if constexpr (std::floating_point<T>) {
    return std::log(x);
  } else {
    using Scalar = scalar_t<T>;
    using Constants = detail::LogConstants<Scalar>;
    const auto [mantissa, exponent] = detail::split_exponent(x);
    const T f = mantissa - T(1);
    const T s = f / (T(2) + f);
    const T z = s * s;
    const T w = z * z;
    const T remainder =
        z * detail::polynomial(Constants::even, w) + w * detail::polynomial(Constants::odd, w);
    const T half_square = T(0.5) * f * f;
    const T low = s * (half_square + remainder) + exponent * T(Constants::ln2_low) + (x - x);
    return exponent * T(Constants::ln2_high) - ((half_square - low) - f);
  }
}

namespace detail {

/// Of exp: where it ends, and 1/k! as far as they are felt for |r| ≤ ln 2 / 2.
template <class Scalar>
struct ExpConstants;

template <>
struct ExpConstants<double> {
  static constexpr double largest = 708, integers = 0x1.8p52;
  static constexpr double taylor[] = {1.0,
                                      1.0,
                                      1.0 / 2,
                                      1.0 / 6,
                                      1.0 / 24,
                                      1.0 / 120,
                                      1.0 / 720,
                                      1.0 / 5040,
                                      1.0 / 40320,
                                      1.0 / 362880,
                                      1.0 / 3628800,
                                      1.0 / 39916800,
                                      1.0 / 479001600,
                                      1.0 / 6227020800};
};

template <>
struct ExpConstants<float> {
  static constexpr float largest = 87, integers = 0x1.8p23F;
  static constexpr float taylor[] = {1.0F,      1.0F,       1.0F / 2,   1.0F / 6,
                                     1.0F / 24, 1.0F / 120, 1.0F / 720, 1.0F / 5040};
};

}  // namespace detail

/// eˣ to about 2 ulp. NaN gives NaN; a pack stops at e^±708 (floats: e^±87), short of overflow.
template <Real T>
EVERT_ALWAYS_INLINE T exp(const T& x) {
  if constexpr (std::floating_point<T>) {
    return std::exp(x);
  } else {
    using Scalar = scalar_t<T>;
    using Constants = detail::ExpConstants<Scalar>;
    using Logarithm = detail::LogConstants<Scalar>;
    const T inside = max(min(x, T(Constants::largest)), T(-Constants::largest));
    // x = n ln 2 + r. Added to `integers`, n stands in the last bits of the mantissa.
    const T shifted = inside * T(Scalar(1.44269504088896340736L)) + T(Constants::integers);
    const T n = shifted - T(Constants::integers);
    const T r = (inside - n * T(Logarithm::ln2_high)) - n * T(Logarithm::ln2_low);
    const T power = T::from_bits((shifted.bits() << Logarithm::mantissa_bits) + T(Scalar(1)).bits());
    return detail::polynomial(Constants::taylor, r) * power;
  }
}

}  // namespace evert
