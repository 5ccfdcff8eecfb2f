#include "vtu_data.hpp"

#include "base64.hpp"
#include "vtk_numbers.hpp"
#include <algorithm>
#include <charconv>
#include <utility>
#include <zlib.h>

namespace evert {
namespace {

/// Decodes one array. Its bytes start with sizes: without compression that of the data, else the number of
/// blocks, the size of a block, that of the last one if it is shorter, and the compressed size of each.
class Decoder {
 public:
  Decoder(const VtuArray& array, const VtuEncoding& encoding, const InputCursor& in)
      : array_(array), encoding_(encoding), in_(in) {}

  std::string bytes() {
    choose_source();
    return encoding_.compressed ? compressed_bytes() : plain_bytes();
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    in_.fail_at(array_.tag.position, "the array '" + array_.tag.attribute("Name") + "' " + message);
  }

  void choose_source() {
    const auto format = array_.tag.attribute("format");
    if (format == "binary") {
      source_ = array_.text;
      base64_ = true;
      return;
    }
    if (format != "appended") fail("has the format '" + format + "'; allowed are ascii, binary and appended");
    const auto offset_text = array_.tag.attribute("offset");
    std::size_t offset = 0;
    const auto end = offset_text.data() + offset_text.size();
    if (std::from_chars(offset_text.data(), end, offset).ptr != end || offset_text.empty())
      fail("must have an offset into the appended data");
    if (offset >= encoding_.appended.size()) fail("begins behind the end of the appended data (truncated?)");
    source_ = encoding_.appended.substr(offset);
    base64_ = encoding_.appended_is_base64;
  }

  /// The first `size` bytes of the array.
  std::string first_bytes(std::size_t size) {
    if (size > source_.size()) fail("is cut short (truncated?)");  // base64 only makes it longer
    if (!base64_) return std::string(source_.substr(0, size));
    auto decoded = from_base64(source_, size);
    if (!decoded) fail("is not written in base64");
    if (decoded->size() < size) fail("is cut short (truncated?)");
    return std::move(*decoded);
  }

  [[nodiscard]] std::size_t size_at(const std::string& bytes, std::size_t index) const {
    InputCursor header(bytes, in_.name());
    header.set_position(index * encoding_.header_bytes);
    return encoding_.header_bytes == 4 ? header.binary<std::uint32_t>("a size", encoding_.swap)
                                       : header.binary<std::uint64_t>("a size", encoding_.swap);
  }

  std::string plain_bytes() {
    const auto header = encoding_.header_bytes;
    const auto size = size_at(first_bytes(header), 0);
    if (size > source_.size()) fail("is cut short (truncated?)");
    return first_bytes(header + size).substr(header);
  }

  std::string compressed_bytes() {
    const auto width = encoding_.header_bytes;
    const auto start = first_bytes(3 * width);
    const auto blocks = size_at(start, 0);
    const auto block_size = size_at(start, 1);
    const auto last_size = size_at(start, 2);
    if (blocks > source_.size() / width) fail("is cut short (truncated?)");
    const auto header_size = (3 + blocks) * width;
    const auto header = first_bytes(header_size);
    std::size_t end = header_size;
    for (std::size_t b = 0; b < blocks; ++b) {
      end += std::min(size_at(header, 3 + b), source_.size());
      if (end > source_.size()) fail("is cut short (truncated?)");
    }
    const auto all = first_bytes(end);
    std::string result;
    std::size_t at = header_size;
    for (std::size_t b = 0; b < blocks; ++b) {
      const auto packed = size_at(header, 3 + b);
      const bool short_block = b + 1 == blocks && last_size > 0;
      unpack(std::string_view(all).substr(at, packed), short_block ? last_size : block_size, result);
      at += packed;
    }
    return result;
  }

  /// Appends the `size` bytes that `packed` holds.
  void unpack(std::string_view packed, std::size_t size, std::string& result) const {
    constexpr std::size_t best_ratio = 1032;  // of zlib's method: more is a lie, not to be allocated
    if (size > best_ratio * packed.size() + 64) fail("promises more data than its compressed bytes can hold");
    const auto begin = result.size();
    result.resize(begin + size);
    auto length = static_cast<uLongf>(size);
    const int status =
        uncompress(reinterpret_cast<Bytef*>(result.data() + begin), &length,
                   reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
    if (status != Z_OK || length != size) fail("cannot be decompressed");
  }

  const VtuArray& array_;
  const VtuEncoding& encoding_;
  const InputCursor& in_;
  std::string_view source_;
  bool base64_ = true;
};

/// Reads all numbers of an array by read_one(cursor, type, binary).
template <class Value, class ReadOne>
std::vector<Value> numbers(const VtuArray& array, const VtuEncoding& encoding, const InputCursor& in,
                           ReadOne&& read_one) {
  const auto type_name = array.tag.attribute("type");
  const auto* type = type_name == "String" ? xml_number_type("Int8") : xml_number_type(type_name);
  if (type == nullptr) in.fail_at(array.tag.position, "'" + type_name + "' is no number type of VTU's");
  std::vector<Value> values;
  if (array.tag.attribute("format", "ascii") == "ascii") {
    InputCursor text = in;  // keeps the file's line numbers
    text.limit_to(array.text);
    while (!text.at_end()) values.push_back(read_one(text, *type, false));
    return values;
  }
  const auto bytes = Decoder(array, encoding, in).bytes();
  if (bytes.size() % type->bytes != 0)
    in.fail_at(array.tag.position, "the array '" + array.tag.attribute("Name") + "' ends within a number");
  InputCursor data(bytes, in.name() + ": array '" + array.tag.attribute("Name") + "'");
  values.reserve(bytes.size() / type->bytes);
  while (data.remaining() > 0) values.push_back(read_one(data, *type, true));
  return values;
}

}  // namespace

std::vector<std::int64_t> vtu_integers(const VtuArray& array, const VtuEncoding& encoding,
                                       const InputCursor& in, std::string_view what) {
  return numbers<std::int64_t>(array, encoding, in,
                               [&](InputCursor& from, const VtkNumberType& type, bool binary) {
                                 return read_integer(from, type, binary, encoding.swap, what);
                               });
}

std::vector<double> vtu_reals(const VtuArray& array, const VtuEncoding& encoding, const InputCursor& in,
                              std::string_view what) {
  return numbers<double>(array, encoding, in, [&](InputCursor& from, const VtkNumberType& type, bool binary) {
    return read_real(from, type, binary, encoding.swap, what);
  });
}

std::vector<std::string> vtu_strings(const VtuArray& array, const VtuEncoding& encoding,
                                     const InputCursor& in) {
  std::vector<std::string> strings(1);
  for (const auto character : vtu_integers(array, encoding, in, "a character")) {
    if (character == 0) {
      strings.emplace_back();
    } else {
      strings.back() += static_cast<char>(character);
    }
  }
  strings.pop_back();  // behind the last 0
  return strings;
}

}  // namespace evert
