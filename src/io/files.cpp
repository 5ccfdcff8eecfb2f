#include "evert/io/files.hpp"

#include "evert/core/error.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <string_view>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>
#include <utility>

namespace evert {
namespace {

[[noreturn]] void fail(const std::string& path, int error) {
  throw UserError("cannot write '" + path + "': " + std::strerror(error));
}

/// Owns a file descriptor; open() and every write are checked.
class Descriptor {
 public:
  Descriptor(const std::string& path, int flags)
      : path_(path), descriptor_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) fail(path_, errno);
  }
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int get() const { return descriptor_; }
  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const auto written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path_, errno);
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  void sync() const {
    // Some file systems cannot, and say so with EINVAL.
    if (::fsync(descriptor_) != 0 && errno != EINVAL) fail(path_, errno);
  }
  void close() {
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(path_, errno);
  }

 private:
  const std::string& path_;
  int descriptor_;
};

std::string directory_of(const std::string& path) {
  const auto parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

}  // namespace

void require_writable(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(directory_of(path), error);
  if (error) fail(path, error.value());
  const bool existed = std::filesystem::exists(path, error);
  Descriptor(path, O_WRONLY | O_CREAT).close();
  if (!existed) ::unlink(path.c_str());
}

void reserve_space(const std::string& path, std::int64_t bytes) {
  const Descriptor file(path, O_WRONLY);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail(path, errno);
  int refused = 0;
  do refused = ::fallocate(file.get(), FALLOC_FL_KEEP_SIZE, status.st_size, bytes);
  while (refused != 0 && errno == EINTR);
  if (refused == 0) return;
  if (errno != EOPNOTSUPP && errno != ENOSYS) fail(path, errno);
  struct statvfs system {};
  if (::fstatvfs(file.get(), &system) != 0) fail(path, errno);
  if (static_cast<std::uintmax_t>(bytes) > std::uintmax_t{system.f_bavail} * system.f_frsize)
    fail(path, ENOSPC);
}

void sync_file(const std::string& path) { Descriptor(path, O_RDONLY).sync(); }

void replace_file(const std::string& from, const std::string& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) fail(to, errno);
  sync_file(directory_of(to));
}

void write_file(const std::string& path, const std::string& content) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    Descriptor(path, O_WRONLY).write(content);
    return;
  }
  const auto resolved = std::filesystem::weakly_canonical(path, error);
  const std::string target = error ? path : resolved.string();
  const std::string temporary = target + ".tmp";
  try {
    Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    file.write(content);
    file.sync();
    file.close();
  } catch (const UserError&) {
    ::unlink(temporary.c_str());
    throw;
  }
  replace_file(temporary, target);
}

}  // namespace evert
