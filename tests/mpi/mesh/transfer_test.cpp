#include "transfer.hpp"

#include "evert/core/collective.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace evert {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

/// Sends from rank 0 to all others in pieces of `piece` bytes and says whether the same arrived.
bool arrives(std::size_t bytes, std::size_t piece) {
  std::vector<unsigned char> sent(bytes);
  std::iota(sent.begin(), sent.end(), static_cast<unsigned char>(3));
  if (rank_of(world) == 0) {
    for (int to = 1; to < size_of(world); ++to) send_bytes(world, to, sent.data(), bytes, piece);
    return true;
  }
  std::vector<unsigned char> got(bytes);
  receive_bytes(world, 0, got.data(), bytes, piece);
  return got == sent;
}

TEST(Transfer, CutsLongArraysIntoPieces) {
  EXPECT_TRUE(arrives(1000, 1));
  EXPECT_TRUE(arrives(1000, 7));
  EXPECT_TRUE(arrives(1000, 1000));
  EXPECT_TRUE(arrives(1001, 1000));
  EXPECT_TRUE(arrives(0, 16));
}

TEST(Transfer, BroadcastsStrings) {
  std::vector<std::string> strings;
  if (rank_of(world) == 0) strings = {"a", "", "with\nline and spaces"};
  broadcast(world, strings);
  EXPECT_EQ(strings, (std::vector<std::string>{"a", "", "with\nline and spaces"}));
}

}  // namespace
}  // namespace evert
