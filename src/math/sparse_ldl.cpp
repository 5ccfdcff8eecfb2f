#include "evert/math/sparse_ldl.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>

namespace evert {
namespace {

std::size_t at(SparseLdl::Index i) { return static_cast<std::size_t>(i); }

}  // namespace

SparseLdl::SparseLdl(Index size, std::span<const Entry> lower)
    : size_(size),
      new_number_(at(size)),
      first_(at(size) + 1),
      parent_(at(size), -1),
      begin_(at(size) + 1),
      filled_(at(size)),
      pivots_(at(size)),
      work_(at(size)),
      right_(at(size)),
      mark_(at(size)),
      path_(at(size)) {
  order(lower);
  row_of_.resize(lower.size());
  value_of_.resize(lower.size());
  for (const auto& [row, column] : lower)
    ++first_[at(std::max(new_number_[at(row)], new_number_[at(column)])) + 1];
  for (Index k = 0; k < size_; ++k) first_[at(k) + 1] += first_[at(k)];
  std::vector<Index> next(first_.begin(), first_.end() - 1);
  for (std::size_t e = 0; e < lower.size(); ++e) {
    const auto [low, high] = std::minmax(new_number_[at(lower[e][0])], new_number_[at(lower[e][1])]);
    const auto place = at(next[at(high)]++);
    row_of_[place] = low;
    value_of_[place] = static_cast<Index>(e);
  }
  find_pattern();
}

/// Approximate minimum degree.
void SparseLdl::order(std::span<const Entry> lower) {
  std::vector<Eigen::Triplet<double, Index>> triplets;
  for (const auto& [row, column] : lower) triplets.emplace_back(row, column, 1.0);
  Eigen::SparseMatrix<double, Eigen::ColMajor, Index> matrix(size_, size_);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> old_number;
  Eigen::AMDOrdering<Index>()(matrix, old_number);
  for (Index k = 0; k < size_; ++k) new_number_[at(old_number.indices()[k])] = k;
}

/// Row k of L has what can be reached from the entries of A's column k up the tree, below k.
void SparseLdl::find_pattern() {
  std::vector<Index> counts(at(size_));
  for (Index k = 0; k < size_; ++k) {
    mark_[at(k)] = k;
    for (Index p = first_[at(k)]; p < first_[at(k) + 1]; ++p)
      for (Index i = row_of_[at(p)]; mark_[at(i)] != k; i = parent_[at(i)]) {
        if (parent_[at(i)] < 0) parent_[at(i)] = k;
        ++counts[at(i)];
        mark_[at(i)] = k;
      }
  }
  for (Index k = 0; k < size_; ++k) begin_[at(k) + 1] = begin_[at(k)] + counts[at(k)];
  rows_.resize(at(begin_[at(size_)]));
  entries_.resize(rows_.size());
}

bool SparseLdl::factor(std::span<const double> values) {
  values_ = values;
  std::ranges::fill(mark_, -1);
  std::ranges::fill(work_, 0.0);
  for (Index k = 0; k < size_; ++k) {
    const double pivot = eliminate(k);
    if (!(pivot > 0)) return false;
    pivots_[at(k)] = pivot;
  }
  return true;
}

/// Row k of L, by a sparse triangular solve; returns its pivot.
double SparseLdl::eliminate(Index k) {
  Index top = size_;  // path_[top, size_): the columns of the row, in the order of elimination
  mark_[at(k)] = k;
  filled_[at(k)] = 0;
  for (Index p = first_[at(k)]; p < first_[at(k) + 1]; ++p) {
    work_[at(row_of_[at(p)])] += values_[at(value_of_[at(p)])];
    Index length = 0;
    for (Index i = row_of_[at(p)]; mark_[at(i)] != k; i = parent_[at(i)]) {
      path_[at(length++)] = i;
      mark_[at(i)] = k;
    }
    while (length > 0) path_[at(--top)] = path_[at(--length)];
  }
  double pivot = work_[at(k)];
  work_[at(k)] = 0;
  for (; top < size_; ++top) {
    const Index i = path_[at(top)];
    const double left = work_[at(i)];
    work_[at(i)] = 0;
    const Index end = begin_[at(i)] + filled_[at(i)]++;
    for (Index p = begin_[at(i)]; p < end; ++p) work_[at(rows_[at(p)])] -= entries_[at(p)] * left;
    const double entry = left / pivots_[at(i)];
    pivot -= entry * left;
    rows_[at(end)] = k;
    entries_[at(end)] = entry;
  }
  return pivot;
}

void SparseLdl::solve(std::span<double> b) const {
  for (Index k = 0; k < size_; ++k) right_[at(new_number_[at(k)])] = b[at(k)];
  for (Index j = 0; j < size_; ++j)
    for (Index p = begin_[at(j)]; p < begin_[at(j) + 1]; ++p)
      right_[at(rows_[at(p)])] -= entries_[at(p)] * right_[at(j)];
  for (Index j = 0; j < size_; ++j) right_[at(j)] /= pivots_[at(j)];
  for (Index j = size_; j-- > 0;)
    for (Index p = begin_[at(j)]; p < begin_[at(j) + 1]; ++p)
      right_[at(j)] -= entries_[at(p)] * right_[at(rows_[at(p)])];
  for (Index k = 0; k < size_; ++k) b[at(k)] = right_[at(new_number_[at(k)])];
}

}  // namespace evert
