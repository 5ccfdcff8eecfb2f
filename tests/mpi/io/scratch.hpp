#pragma once
#include "evert/core/collective.hpp"

#include <gtest/gtest.h>
#include <mpi.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/mount.h>

namespace evert::test {

/// A directory for the files of one test, the same on all ranks; removed at the end. Collective.
class Scratch {
 public:
  Scratch() {
    std::array<char, 64> name{};
    if (rank_of(MPI_COMM_WORLD) == 0) {
      std::string pattern = (std::filesystem::temp_directory_path() / "evert_test_XXXXXX").string();
      if (mkdtemp(pattern.data()) != nullptr) pattern.copy(name.data(), name.size() - 1);
    }
    MPI_Bcast(name.data(), static_cast<int>(name.size()), MPI_CHAR, 0, MPI_COMM_WORLD);
    path_ = name.data();
  }
  ~Scratch() {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank_of(MPI_COMM_WORLD) == 0) std::filesystem::remove_all(path_);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] std::string operator/(const std::string& file) const { return path_ + "/" + file; }

 private:
  std::string path_;
};

/// A file system of a few kilobytes, where the machine lets us mount one. Collective.
class SmallDisk {
 public:
  SmallDisk(std::string where, const std::string& size) : where_(std::move(where)) {
    int mounted = 0;
    if (rank_of(MPI_COMM_WORLD) == 0) {
      std::filesystem::create_directories(where_);
      mounted = mount("tmpfs", where_.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0 ? 1 : 0;
    }
    MPI_Bcast(&mounted, 1, MPI_INT, 0, MPI_COMM_WORLD);
    mounted_ = mounted == 1;
  }
  ~SmallDisk() {
    MPI_Barrier(MPI_COMM_WORLD);
    if (mounted_ && rank_of(MPI_COMM_WORLD) == 0) umount2(where_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  [[nodiscard]] bool mounted() const { return mounted_; }
  [[nodiscard]] std::string operator/(const std::string& file) const { return where_ + "/" + file; }

 private:
  std::string where_;
  bool mounted_ = false;
};

inline std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  return std::move(content).str();
}

/// The message of the UserError that `work` throws; "" when it throws none.
template <class Work>
std::string user_error_of(Work&& work) {
  try {
    work();
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

}  // namespace evert::test
