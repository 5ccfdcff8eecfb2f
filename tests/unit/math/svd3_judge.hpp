#pragma once
#include "evert/math/vec3.hpp"

#include "level_kernels.hpp"
#include <ostream>
#include <vector>

namespace evert::test {

/// Matrices as the level kernels take them.
class MatrixArray {
 public:
  /// `count` must be a multiple of 16.
  explicit MatrixArray(std::size_t count) : count_(count), entries_(9 * count) {}

  void set(std::size_t i, const Mat3d& f);
  [[nodiscard]] Mat3d get(std::size_t i) const;
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] const double* data() const { return entries_.data(); }

 private:
  std::size_t count_;
  std::vector<double> entries_;
};

/// The worst of many decompositions, judged in long double. Norms are Frobenius'; NaN counts as infinitely
/// wrong.
struct Verdict {
  long double reconstruction = 0;   ///< ‖F − UΣVᵀ‖ / ‖F‖
  long double orthonormality = 0;   ///< ‖UᵀU − I‖, ‖VᵀV − I‖
  long double isotropic = 0;        ///< ‖F − isotropic_tensor(stretches)‖ / ‖F‖
  long double rotation = 0;         ///< ‖QᵀQ − I‖ of the polar rotation
  long double disagreement = 0;     ///< of the isotropic form with U diag(p) Vᵀ
  std::size_t misordered = 0;       ///< not |σ1| ≥ |σ2| ≥ |σ3|, or σ1, σ2 negative
  std::size_t wrong_sign = 0;       ///< σ3 < 0 where det F > 0, or the reverse, |σ3| being above rounding
  std::size_t not_rotations = 0;    ///< det U, det V or det Q is not +1
  std::size_t wrong_stretches = 0;  ///< the isotropic form's stretches are not the σ
  Mat3d worst{};                    ///< where the first four are largest

  [[nodiscard]] long double largest_error() const;
  void merge(const Verdict& other);
};

std::ostream& operator<<(std::ostream& out, const Verdict& verdict);

/// Runs both forms of the SVD of one CPU level on all matrices and judges every result.
Verdict judge(const LevelKernels& level, const MatrixArray& matrices);

/// Asserts (GoogleTest) what PHYSICS 2 demands, with the given bound on the errors.
void expect_accurate(const Verdict& verdict, long double bound);

}  // namespace evert::test
