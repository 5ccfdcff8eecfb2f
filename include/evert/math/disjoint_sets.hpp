#pragma once
#include <cstddef>
#include <numeric>
#include <vector>

namespace evert {

/// Sets of the numbers below a count, each on its own at first, that are joined one by one.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  /// A member of the set of `member`, the same for all of the set until the next join().
  [[nodiscard]] std::size_t root(std::size_t member) {
    while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];  // halves the path
    return member;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace evert
