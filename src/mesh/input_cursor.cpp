#include "input_cursor.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <system_error>

namespace evert {
namespace {

constexpr bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r') || c == '\0'; }

/// For messages: long or unprintable words are cut short.
std::string quoted(std::string_view word) {
  constexpr std::size_t longest = 40;
  std::string text = "'";
  for (const char c : word.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > longest ? "...'" : "'");
}

/// A number outside the range of double: tiny ones are 0, huge ones are infinite.
double beyond_range(std::string_view word) { return std::strtod(std::string(word).c_str(), nullptr); }

}  // namespace

std::string read_whole_file(const std::filesystem::path& path) {
  const auto name = path.string();
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw UserError(name + ": there is no such file");
  if (std::filesystem::is_directory(status)) throw UserError(name + ": is a directory, not a file");
  if (!std::filesystem::is_regular_file(status)) throw UserError(name + ": is not a regular file");
  const auto size = std::filesystem::file_size(path, error);
  std::ifstream stream(path, std::ios::binary);
  if (error || !stream) throw UserError(name + ": cannot be opened for reading (no permission?)");
  if (size == 0) throw UserError(name + ": is empty");
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(size));
  if (!stream) throw UserError(name + ": cannot be read to its end");
  return text;
}

void InputCursor::skip_blanks() {
  while (position_ < text_.size()) {
    if (is_blank(text_[position_])) {
      ++position_;
    } else if (comment_ != '\0' && text_[position_] == comment_) {
      position_ = std::min(text_.find('\n', position_), text_.size());
    } else {
      return;
    }
  }
}

void InputCursor::limit_to(std::string_view part) {
  position_ = last_ = part.empty() ? text_.size() : static_cast<std::size_t>(part.data() - text_.data());
  text_ = text_.substr(0, position_ + part.size());
  limited_ = true;
}

bool InputCursor::at_end() {
  skip_blanks();
  return position_ == text_.size();
}

std::string_view InputCursor::peek_word() {
  skip_blanks();
  auto end = position_;
  while (end < text_.size() && !is_blank(text_[end])) ++end;
  return text_.substr(position_, end - position_);
}

std::string_view InputCursor::word(std::string_view what) {
  const auto word = peek_word();
  in_bytes_ = false;
  last_ = position_;
  if (word.empty()) fail_at_end(what);
  position_ += word.size();
  return word;
}

std::string_view InputCursor::rest_of_line() {
  in_bytes_ = false;
  last_ = position_;
  const auto end = std::min(text_.find('\n', position_), text_.size());
  auto line = text_.substr(position_, end - position_);
  position_ = std::min(end + 1, text_.size());
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  return line;
}

std::int64_t InputCursor::integer(std::string_view what) {
  const auto digits = word(what);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size())
    fail(std::string(what) + " must be a whole number, not " + quoted(digits));
  if (position_ == text_.size() && !limited_) fail_at_end("the line end after " + std::string(what));
  return value;
}

double InputCursor::real(std::string_view what) {
  const auto digits = word(what);
  const bool plus = digits.front() == '+';
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data() + plus, digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (whole && error == std::errc::result_out_of_range) value = beyond_range(digits);
  if (!whole || error == std::errc::invalid_argument)
    fail(std::string(what) + " must be a number, not " + quoted(digits));
  if (!std::isfinite(value)) fail(std::string(what) + " must be a finite number, not " + quoted(digits));
  if (position_ == text_.size() && !limited_) fail_at_end("the line end after " + std::string(what));
  return value;
}

GlobalIndex InputCursor::count(std::string_view what, std::size_t bytes_each) {
  return plausible_count(integer(what), what, bytes_each);
}

GlobalIndex InputCursor::plausible_count(std::int64_t value, std::string_view what,
                                         std::size_t bytes_each) const {
  if (value < 0) fail(std::string(what) + " must not be negative, but is " + std::to_string(value));
  if (static_cast<std::size_t>(value) > remaining() / bytes_each)
    fail(std::string(what) + " is " + std::to_string(value) + ", more than the remaining " +
         std::to_string(remaining()) + " bytes of the file can hold (truncated?)");
  return value;
}

std::string_view InputCursor::bytes(std::size_t size, std::string_view what) {
  in_bytes_ = true;
  last_ = position_;
  if (size > remaining()) fail_at_end(what);
  const auto raw = text_.substr(position_, size);
  position_ += size;
  return raw;
}

void InputCursor::fail_at_end(std::string_view what) const {
  fail_at(text_.size(), "the file ends where " + std::string(what) + " is expected (truncated?)");
}

void InputCursor::fail_at(std::size_t position, const std::string& message) const {
  if (in_bytes_) throw UserError(name_ + ": byte " + std::to_string(position) + ": " + message);
  const auto before = text_.substr(0, position);
  auto line = 1 + std::ranges::count(before, '\n');
  if (position == text_.size() && before.ends_with('\n'))
    --line;  // the last line, not the empty one after it
  throw UserError(name_ + ":" + std::to_string(line) + ": " + message);
}

}  // namespace evert
