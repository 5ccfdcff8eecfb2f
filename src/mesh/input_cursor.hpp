#pragma once
#include "evert/core/error.hpp"
#include "evert/core/index.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace evert {

/// The whole content of a file. Throws UserError when it is missing, no regular file, unreadable or empty.
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& path);

/// Walks through a mesh file held in memory, by words and numbers or by bytes. Every failure is a UserError
/// that names the file and the line, or the byte after binary reading. `what` names in each call the thing
/// wanted.
class InputCursor {
 public:
  /// `text` must outlive the cursor. `name` is the file's name in messages.
  InputCursor(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t position() const { return position_; }
  /// Where the thing read last begins.
  [[nodiscard]] std::size_t last_position() const { return last_; }
  [[nodiscard]] std::size_t remaining() const { return text_.size() - position_; }
  /// Everything not read yet.
  [[nodiscard]] std::string_view rest() const { return text_.substr(position_); }
  void set_position(std::size_t position) { position_ = position; }
  /// Goes to the start of `part`, a part of the text, and takes the end of it for the end of the file.
  void limit_to(std::string_view part);
  /// Turns the rest of a line after this character into blanks; none by default.
  void set_comment(char mark) { comment_ = mark; }

  /// True when nothing but blanks and comments is left.
  [[nodiscard]] bool at_end();
  /// The next word, or "" at the end, without moving past it.
  [[nodiscard]] std::string_view peek_word();
  [[nodiscard]] std::string_view word(std::string_view what);
  /// What is left of this line, without blanks at its ends; moves behind the line's end.
  std::string_view rest_of_line();
  [[nodiscard]] std::int64_t integer(std::string_view what);
  /// A finite number.
  [[nodiscard]] double real(std::string_view what);
  /// An integer ≥ 0 such that so many things of at least `bytes_each` bytes still fit into the file: what is
  /// read next may be allocated in advance.
  [[nodiscard]] GlobalIndex count(std::string_view what, std::size_t bytes_each);
  /// The same check for a number got elsewhere.
  GlobalIndex plausible_count(std::int64_t value, std::string_view what, std::size_t bytes_each) const;

  /// One value as it lies in memory, its bytes reversed if `swap`.
  template <class T>
  [[nodiscard]] T binary(std::string_view what, bool swap) {
    const auto source = bytes(sizeof(T), what);
    std::array<char, sizeof(T)> raw{};
    for (std::size_t i = 0; i < sizeof(T); ++i) raw[i] = source[swap ? sizeof(T) - 1 - i : i];
    return std::bit_cast<T>(raw);
  }
  /// The next `size` bytes.
  [[nodiscard]] std::string_view bytes(std::size_t size, std::string_view what);

  /// "file.msh:12: message" or "file.msh: byte 345: message", for the thing read last.
  [[noreturn]] void fail(const std::string& message) const { fail_at(last_, message); }
  /// The same for an earlier position.
  [[noreturn]] void fail_at(std::size_t position, const std::string& message) const;

 private:
  void skip_blanks();
  [[noreturn]] void fail_at_end(std::string_view what) const;

  std::string_view text_;
  bool limited_ = false;  // text_ ends before the file does
  std::string name_;
  std::size_t position_ = 0;
  std::size_t last_ = 0;  // where the last thing read began
  char comment_ = '\0';
  bool in_bytes_ = false;
};

}  // namespace evert
