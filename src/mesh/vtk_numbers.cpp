#include "vtk_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace evert {
namespace {

constexpr std::array number_types{
    VtkNumberType{"unsigned_char", "UInt8", 1, VtkNumberType::unsigned_integer},
    VtkNumberType{"char", "Int8", 1, VtkNumberType::signed_integer},
    VtkNumberType{"unsigned_short", "UInt16", 2, VtkNumberType::unsigned_integer},
    VtkNumberType{"short", "Int16", 2, VtkNumberType::signed_integer},
    VtkNumberType{"unsigned_int", "UInt32", 4, VtkNumberType::unsigned_integer},
    VtkNumberType{"int", "Int32", 4, VtkNumberType::signed_integer},
    VtkNumberType{"vtkIdType", "", 4, VtkNumberType::signed_integer},  // legacy files store 4 bytes
    VtkNumberType{"unsigned_long", "", 8, VtkNumberType::unsigned_integer},
    VtkNumberType{"long", "", 8, VtkNumberType::signed_integer},
    VtkNumberType{"vtktypeint64", "Int64", 8, VtkNumberType::signed_integer},
    VtkNumberType{"vtktypeuint64", "UInt64", 8, VtkNumberType::unsigned_integer},
    VtkNumberType{"float", "Float32", 4, VtkNumberType::real},
    VtkNumberType{"double", "Float64", 8, VtkNumberType::real},
};

const VtkNumberType* find_type(std::string_view VtkNumberType::*member, std::string_view name) {
  const auto found = std::ranges::find(number_types, name, member);
  return found == number_types.end() || name.empty() ? nullptr : &*found;
}

std::int64_t integer_from_bytes(InputCursor& in, const VtkNumberType& type, bool swap,
                                std::string_view what) {
  const bool is_signed = type.kind == VtkNumberType::signed_integer;
  switch (type.bytes) {
    case 1:
      return is_signed ? in.binary<std::int8_t>(what, swap) : in.binary<std::uint8_t>(what, swap);
    case 2:
      return is_signed ? in.binary<std::int16_t>(what, swap) : in.binary<std::uint16_t>(what, swap);
    case 4:
      return is_signed ? in.binary<std::int32_t>(what, swap)
                       : static_cast<std::int64_t>(in.binary<std::uint32_t>(what, swap));
    default:
      return in.binary<std::int64_t>(what, swap);  // beyond 2^63: negative, and refused as such
  }
}

}  // namespace

const VtkNumberType* legacy_number_type(std::string_view name) {
  return find_type(&VtkNumberType::legacy_name, name);
}
const VtkNumberType* xml_number_type(std::string_view name) {
  return find_type(&VtkNumberType::xml_name, name);
}

std::int64_t read_integer(InputCursor& in, const VtkNumberType& type, bool binary, bool swap,
                          std::string_view what) {
  if (type.kind == VtkNumberType::real) in.fail(std::string(what) + " must be of an integer type");
  return binary ? integer_from_bytes(in, type, swap, what) : in.integer(what);
}

double read_real(InputCursor& in, const VtkNumberType& type, bool binary, bool swap, std::string_view what) {
  if (!binary) return in.real(what);
  if (type.kind != VtkNumberType::real) return static_cast<double>(integer_from_bytes(in, type, swap, what));
  const double value = type.bytes == 4 ? in.binary<float>(what, swap) : in.binary<double>(what, swap);
  if (!std::isfinite(value)) in.fail(std::string(what) + " must be a finite number");
  return value;
}

}  // namespace evert
