#include "evert/math/lane_transpose.hpp"
#include "evert/math/svd3_run.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

// svd3_batch, compiled once per CPU level. As in forces/kernels/level.cpp, nothing here may leave an
// out-of-line copy of a function that other sources define too.
namespace evert::detail::EVERT_KERNEL_LEVEL {

/// Numbers of a Mat3d and of an Svd3<double> (u, sigma, v), which are read and written as arrays of them.
inline constexpr std::size_t matrix_numbers = 9, svd_numbers = 21;
static_assert(sizeof(Mat3d) == matrix_numbers * sizeof(double));
static_assert(sizeof(Svd3<double>) == svd_numbers * sizeof(double));

/// Three numbers of each of lanes_v<T> structures. May read one double past the last.
template <Real T>
EVERT_ALWAYS_INLINE Vec3<T> load_structures(const double* from, std::size_t stride) {
  Rows<T> rows;
  for (std::size_t l = 0; l < lanes_v<T>; ++l) rows[l] = load_row<T>(from + l * stride);
  return components<T>(rows);
}

template <Real T>
EVERT_ALWAYS_INLINE void store_structures(const Vec3<T>& value, double* to, std::size_t stride) {
  const Rows<T> rows = rows_of_lanes<T>(value);
  for (std::size_t l = 0; l < lanes_v<T>; ++l) store_row(to + l * stride, rows[l]);
}

/// More than these and their results do not stay in a cache of two megabytes.
inline constexpr std::size_t cached_matrices = (std::size_t{1} << 21) / ((matrix_numbers + svd_numbers) * 8);

template <Real T>
using Scales = typename Svd3Run<T>::template PerPoint<T>;

/// Matrices brought to a size that the stages take.
template <Real T>
EVERT_STAGE void load_stage(const double* f, std::size_t packs, Svd3Run<T>& run, Scales<T>& scales) {
  for (std::size_t i = 0; i < packs; ++i, f += lanes_v<T> * matrix_numbers) {
    const Mat3<T> any{load_structures<T>(f, matrix_numbers), load_structures<T>(f + 3, matrix_numbers),
                      load_structures<T>(f + 6, matrix_numbers)};
    const ScaledMatrix<T> scaled = scale_to_unit(any);
    run.deformation_gradient[i] = scaled.f;
    scales[i] = scaled.scale;
  }
}

template <Real T>
EVERT_STAGE void store_stage(const Svd3Run<T>& run, const Scales<T>& scales, std::size_t packs, double* svd) {
  for (std::size_t i = 0; i < packs; ++i, svd += lanes_v<T> * svd_numbers) {
    const Svd3<T> found = assemble_svd3(run.deflation(i, scales[i]));
    for (std::size_t j = 0; j < 3; ++j) {
      store_structures(found.u.column[j], svd + 3 * j, svd_numbers);
      store_structures(found.v.column[j], svd + 12 + 3 * j, svd_numbers);
    }
    store_structures(found.sigma, svd + 9, svd_numbers);
  }
}

/// Copies past the caches where the processor can: results that do not fit into them anyway would first be
/// read, line by line, to be overwritten.
EVERT_ALWAYS_INLINE void copy_past_caches(const double* from, std::size_t count, double* to) {
#if defined(__SSE2__)
  std::size_t i = 0;
  const auto stream_one = [&] {
    _mm_stream_si64(reinterpret_cast<long long*>(to + i), std::bit_cast<long long>(from[i]));
    ++i;
  };
  if (reinterpret_cast<std::uintptr_t>(to) % 16 != 0 && count > 0) stream_one();
  for (; i + 2 <= count; i += 2) _mm_stream_pd(to + i, _mm_loadu_pd(from + i));
  if (i < count) stream_one();
#else
  std::memcpy(to, from, count * sizeof(double));
#endif
}

/// Whole packs. One double past the last matrix must be readable.
template <Real T>
void svd3_of_packs(const double* f, std::size_t packs, double* svd, bool past_caches) {
  constexpr std::size_t capacity = Svd3Run<T>::capacity;
  Svd3Run<T> run;
  Scales<T> scales;
  double results[capacity * lanes_v<T> * svd_numbers];
  for (std::size_t first = 0; first < packs; first += capacity) {
    const std::size_t some = packs - first < capacity ? packs - first : capacity;
    double* to = svd + first * lanes_v<T> * svd_numbers;
    const double* from = f + first * lanes_v<T> * matrix_numbers;
    load_stage(from, some, run, scales);
    // The next run travels while this one is computed.
    constexpr std::size_t numbers = capacity * lanes_v<T> * matrix_numbers;
    if (first + 2 * capacity <= packs) {
      for (std::size_t i = 0; i < numbers; i += 8) __builtin_prefetch(from + numbers + i);
    }
    diagonalize(run, some);
    store_stage(run, scales, some, past_caches ? results : to);
    if (past_caches) copy_past_caches(results, some * lanes_v<T> * svd_numbers, to);
  }
#if defined(__SSE2__)
  if (past_caches) _mm_sfence();
#endif
}

/// The last pack, which may be incomplete, goes through copies with padding.
template <Real T>
void svd3_of_array(const Mat3d* f, std::size_t count, Svd3<double>* svd) {
  if (count == 0) return;
  constexpr std::size_t lanes = lanes_v<T>;
  const std::size_t packs = (count - 1) / lanes;
  const double* numbers = f->column[0].components.data();
  double* results = svd->u.column[0].components.data();
  svd3_of_packs<T>(numbers, packs, results, count > cached_matrices);

  const std::size_t done = packs * lanes, rest = count - done;
  double last[lanes * matrix_numbers + 1] = {};
  double last_results[lanes * svd_numbers];
  std::memcpy(last, numbers + done * matrix_numbers, rest * sizeof(Mat3d));
  svd3_of_packs<T>(last, 1, last_results, false);
  std::memcpy(results + done * svd_numbers, last_results, rest * sizeof(Svd3<double>));
}

void svd3_batch(const Mat3d* f, std::size_t count, Svd3<double>* svd) { svd3_of_array<Pack>(f, count, svd); }

}  // namespace evert::detail::EVERT_KERNEL_LEVEL
