#include "evert/io/files.hpp"

#include "evert/core/error.hpp"

#include <gtest/gtest.h>

#include "../../mpi/io/scratch.hpp"
#include <filesystem>
#include <fstream>
#include <limits>

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
