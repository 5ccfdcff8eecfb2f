#include "evert/io/files.hpp"

#include "evert/core/error.hpp"

#include <gtest/gtest.h>

#include "../../mpi/io/scratch.hpp"
#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sys/stat.h>
#include <unistd.h>

namespace evert {
namespace {

/// A directory that is removed at the end.
class Directory {
 public:
  Directory() : path_((std::filesystem::temp_directory_path() / "evert_unit_XXXXXX").string()) {
    EXPECT_NE(mkdtemp(path_.data()), nullptr);
  }
  ~Directory() { std::filesystem::remove_all(path_); }
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;
  [[nodiscard]] std::string operator/(const std::string& file) const { return path_ + "/" + file; }

 private:
  std::string path_;
};

TEST(Files, WriteFileReplacesTheWhole) {
  const Directory directory;
  write_file(directory / "file", "a long first text");
  write_file(directory / "file", "second");
  EXPECT_EQ(test::content_of(directory / "file"), "second");
  EXPECT_FALSE(std::filesystem::exists(directory / "file.tmp"));
}

TEST(Files, WriteFileReplacesNoLinkAndNoPipe) {
  const Directory directory;
  write_file(directory / "file", "text");
  std::filesystem::create_symlink("file", directory / "link");
  write_file(directory / "link", "by the link");
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
  EXPECT_EQ(test::content_of(directory / "file"), "by the link");

  ASSERT_EQ(mkfifo((directory / "pipe").c_str(), 0600), 0);
  const int reader = open((directory / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  write_file(directory / "pipe", "through the pipe");
  EXPECT_TRUE(std::filesystem::is_fifo(directory / "pipe"));
  std::string received(64, ' ');
  received.resize(static_cast<std::size_t>(std::max<ssize_t>(read(reader, received.data(), 64), 0)));
  close(reader);
  EXPECT_EQ(received, "through the pipe");
}

TEST(Files, RequireWritableMakesDirectoriesButNoFile) {
  const Directory directory;
  require_writable(directory / "a/b/file");
  EXPECT_TRUE(std::filesystem::is_directory(directory / "a/b"));
  EXPECT_FALSE(std::filesystem::exists(directory / "a/b/file"));
}

TEST(Files, RequireWritableLeavesAFileAsItIs) {
  const Directory directory;
  write_file(directory / "file", "text");
  require_writable(directory / "file");
  EXPECT_EQ(test::content_of(directory / "file"), "text");
}

TEST(Files, RequireWritableNamesThePathAndTheReason) {
  const Directory directory;
  EXPECT_EQ(test::user_error_of([&] { require_writable(directory / ""); }),
            "cannot write '" + (directory / "") + "': Is a directory");
  write_file(directory / "file", "text");
  EXPECT_EQ(test::user_error_of([&] { require_writable(directory / "file/other"); }),
            "cannot write '" + (directory / "file/other") + "': Not a directory");
}

TEST(Files, ReservedSpaceDoesNotShow) {
  const Directory directory;
  write_file(directory / "file", "text");
  reserve_space(directory / "file", 100000);
  EXPECT_EQ(test::content_of(directory / "file"), "text");
}

TEST(Files, MoreSpaceThanThereIsCannotBeReserved) {
  const Directory directory;
  write_file(directory / "file", "text");
  EXPECT_THROW(reserve_space(directory / "file", std::numeric_limits<std::int64_t>::max() / 2), UserError);
}

}  // namespace
}  // namespace evert
