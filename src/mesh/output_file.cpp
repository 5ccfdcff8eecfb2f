#include "output_file.hpp"

#include "evert/core/error.hpp"

#include <cerrno>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace evert {

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  if (std::filesystem::exists(path_, error) && !std::filesystem::is_regular_file(path_, error))
    throw UserError(path_.string() + ": cannot be written: it exists and is not a regular file");
  temporary_ = path_;
  temporary_ += ".part" + std::to_string(getpid());
  file_.reset(std::fopen(temporary_.c_str(), "wb"));
  if (!file_) fail(errno);
}

OutputFile::~OutputFile() {
  if (!file_) return;
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

OutputFile& OutputFile::operator<<(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail(errno);
  return *this;
}

void OutputFile::commit() {
  // Errors of a full disk may show only now, or even only when the data reaches it.
  if (std::fflush(file_.get()) != 0 || fsync(fileno(file_.get())) != 0) fail(errno);
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) fail(error.value());
  file_.reset();
}

void OutputFile::fail(int error) const {
  throw UserError(path_.string() + ": cannot be written: " + std::generic_category().message(error));
}

}  // namespace evert
