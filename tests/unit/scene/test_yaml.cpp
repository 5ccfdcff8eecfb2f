#include <gtest/gtest.h>
#include <mpi.h>

#include "scenes.hpp"
#include <algorithm>
#include <filesystem>
#include <fstream>

/// Files that are no scenes, by accident or by intent.
namespace evert {
namespace {

using testing::complaint;
using testing::least_scene;

std::string repeated(const std::string& text, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += text;
  return out;
}

TEST(Yaml, must_hold_something) {
  EXPECT_EQ(complaint(""), "scene.yaml: holds nothing");
  EXPECT_EQ(complaint("\n\n"), "scene.yaml: holds nothing");
  EXPECT_EQ(complaint("# a comment\n"), "scene.yaml: holds nothing");
  EXPECT_EQ(complaint("---\n...\n"), "scene.yaml: holds nothing");
}

TEST(Yaml, must_be_a_map) {
  EXPECT_EQ(complaint("- a\n- b\n"),
            "scene.yaml:1: must be a map of keys (name: ..., end_time: ...), not a list");
  EXPECT_EQ(complaint("hello\n"),
            "scene.yaml:1: must be a map of keys (name: ..., end_time: ...), not 'hello'");
}

TEST(Yaml, must_be_one_document) {
  EXPECT_EQ(complaint(least_scene + "---\nname: b\n"), "scene.yaml: holds 2 YAML documents, must be one");
}

TEST(Yaml, names_the_line_of_bad_syntax) {
  for (const auto* text :
       {"name: a\nend_time: [1, 2\nbodies: {}\n", "name: a\n\tend_time: 1\n", "name: a\nend_time: *nowhere\n",
        "name: a\n}\n", "name: a\n  b: c\n", "name: @a\n"}) {
    const auto message = complaint(text);
    EXPECT_NE(message.find("not valid YAML: "), std::string::npos) << message;
    EXPECT_TRUE(message.starts_with("scene.yaml:")) << message;
    EXPECT_NE(message.substr(11, 1), "0") << message;
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
  }
}

TEST(Yaml, must_not_be_binary) {
  EXPECT_EQ(complaint(std::string("name: a\0b", 9)), "scene.yaml: holds zero bytes: a scene is YAML text");
  std::string bytes;
  for (int i = 1; i < 256; ++i) bytes += static_cast<char>(i);
  EXPECT_NE(complaint(bytes), "nothing");
  EXPECT_NE(complaint("\xff\xfe" + least_scene), "nothing");
}

TEST(Yaml, may_not_be_deep) {
  EXPECT_EQ(complaint("name: " + repeated("[", 40) + repeated("]", 40)),
            "scene.yaml:1: nested more than 32 levels deep");
  EXPECT_NE(complaint("name: " + repeated("[", 100'000)), "nothing");
  EXPECT_NE(complaint(repeated("{a: ", 100'000)), "nothing");
  EXPECT_NE(complaint(repeated("- ", 100'000)), "nothing");
}

TEST(Yaml, may_not_expand_without_bounds) {
  std::string bomb = "a: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const auto last = "*a" + std::to_string(i - 1);
    bomb += std::string(1, static_cast<char>('a' + i)) + ": &a" + std::to_string(i) + " [" +
            repeated(last + ", ", 9) + last + "]\n";
  }
  EXPECT_NE(complaint(bomb).find("more than 200000 values (aliases expanded)"), std::string::npos);
  EXPECT_NE(complaint("name: &a [*a]\n"), "nothing");
  EXPECT_NE(complaint("&a name: {b: *a}\n"), "nothing");
}

TEST(Yaml, has_no_tags) {
  EXPECT_EQ(complaint("name: !!python/object a\n").find("scene.yaml:1: the tag "), 0U);
  EXPECT_EQ(complaint(testing::changed(least_scene, "end_time: 1", "end_time: !<x> 1"))
                .find("scene.yaml:2: the tag "),
            0U);
}

TEST(Yaml, has_plain_keys) {
  EXPECT_EQ(complaint("[a, b]: c\n"), "scene.yaml:1: a key must be a word, not a list or a map");
  EXPECT_NE(complaint("? {a: b}\n: c\n"), "nothing");
}

TEST(Yaml, cut_anywhere_is_refused_or_read) {
  for (std::size_t length = 0; length < testing::full_scene.size(); ++length)
    EXPECT_NO_THROW(complaint(testing::full_scene.substr(0, length))) << length;
}

/// A folder of its own, gone at the end.
class Files : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("evert_scene_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::string load(const std::filesystem::path& path) {
    try {
      return "name " + load_scene(MPI_COMM_SELF, path.string()).name;
    } catch (const UserError& error) {
      return error.what();
    }
  }

  std::filesystem::path folder_;
};

TEST_F(Files, are_read) {
  std::ofstream(folder_ / "a.yaml") << least_scene;
  EXPECT_EQ(load(folder_ / "a.yaml"), "name least");
}

TEST_F(Files, must_exist) {
  EXPECT_EQ(load(folder_ / "b.yaml"), (folder_ / "b.yaml").string() + ": there is no such file");
  EXPECT_EQ(load(""), ": there is no such file");
}

TEST_F(Files, must_be_files) {
  EXPECT_EQ(load(folder_), folder_.string() + ": is a directory, not a scene file");
  EXPECT_EQ(load("/dev/zero"), "/dev/zero: is not a regular file");
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(load(pipe), pipe.string() + ": is not a regular file");
}

TEST_F(Files, must_be_small) {
  const auto path = folder_ / "large.yaml";
  std::ofstream(path) << "name: a\n";
  std::filesystem::resize_file(path, 1U << 30U);  // sparse
  EXPECT_EQ(load(path), path.string() + ": larger than 16 MiB: not a scene");
}

}  // namespace
}  // namespace evert

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  ::testing::InitGoogleTest(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  MPI_Finalize();
  return failed;
}
