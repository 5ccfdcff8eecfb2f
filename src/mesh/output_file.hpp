#pragma once
#include "number_text.hpp"
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace evert {

/// A file that appears under its name only when it is complete: written beside it, then renamed. All failures
/// are UserErrors that name the file and the reason.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  /// Removes what was written, unless committed.
  ~OutputFile();

  OutputFile& operator<<(std::string_view text);
  OutputFile& operator<<(char c) { return *this << std::string_view(&c, 1); }
  /// Numbers in the shortest form that reads back exactly.
  OutputFile& operator<<(double value) { return write_number(value); }
  OutputFile& operator<<(std::int64_t value) { return write_number(value); }
  OutputFile& operator<<(int value) { return write_number(value); }

  void commit();

 private:
  template <class Number>
  OutputFile& write_number(Number value) {
    return *this << std::string_view(shortest(value));
  }
  [[noreturn]] void fail(int error) const;

  struct Close {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
  };
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace evert
