#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace evert {

/// A = L D Lᵀ of a sparse symmetric positive definite matrix whose pattern stays and whose entries change:
/// ordering and pattern of L are found once, and neither factor() nor solve() allocates. Parts of A that are
/// not connected cost as much as if each were factored by itself.
///
/// Row by row, along the elimination tree: Davis, Algorithm 849: a concise sparse Cholesky factorization
/// package, ACM TOMS 31 (2005).
class SparseLdl {
 public:
  using Index = std::int32_t;
  /// Row and column, row ≥ column.
  using Entry = std::array<Index, 2>;

  /// `lower`: the entries of the lower triangle, each once, all of the diagonal among them.
  SparseLdl(Index size, std::span<const Entry> lower);

  /// `values` in the order of `lower`. False where a pivot is not positive: A is not positive definite, or
  /// not finite.
  [[nodiscard]] bool factor(std::span<const double> values);
  /// b ← A⁻¹ b
  void solve(std::span<double> b) const;

  /// Entries of L below its diagonal.
  [[nodiscard]] std::size_t fill() const { return rows_.size(); }

 private:
  void order(std::span<const Entry> lower);
  void find_pattern();
  double eliminate(Index row);

  Index size_;
  std::vector<Index> new_number_;  // of a row of A
  // The upper triangle of the ordered A by columns: for each entry its row and where its value comes from.
  std::vector<Index> first_, row_of_, value_of_;
  std::vector<Index> parent_;                 // in the elimination tree; −1: a root
  std::vector<Index> begin_, rows_, filled_;  // L by columns: begin, rows, how much of one is there
  std::vector<double> entries_, pivots_;      // of L; of D
  std::vector<double> work_;
  mutable std::vector<double> right_;
  std::vector<Index> mark_, path_;
  std::span<const double> values_;  // those of the factor() that goes on
};

}  // namespace evert
