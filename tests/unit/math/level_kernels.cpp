#include "level_kernels.hpp"

#include "evert/math/svd3.hpp"

#include "pack_operations.hpp"

#define EVERT_NAME_OF(level) #level
#define EVERT_STRING(level) EVERT_NAME_OF(level)

namespace evert::test::EVERT_KERNEL_LEVEL {

namespace {

template <class P>
void operate(Operation operation, const scalar_t<P>* x, const scalar_t<P>* y, scalar_t<P>* result,
             std::size_t count) {
  for (std::size_t i = 0; i < count; i += lanes_v<P>) {
    store(apply(operation, load<P>(x + i), load<P>(y + i)), result + i);
  }
}

Mat3<Pack> load_matrix(const double* f, std::size_t i, std::size_t count) {
  Mat3<Pack> m;
  for (std::size_t c = 0; c < 9; ++c) m(c % 3, c / 3) = load<Pack>(f + c * count + i);
  return m;
}

void store_matrix(const Mat3<Pack>& m, double* f, std::size_t i, std::size_t count) {
  for (std::size_t c = 0; c < 9; ++c) store(m(c % 3, c / 3), f + c * count + i);
}

void store_vector(const Vec3<Pack>& a, double* f, std::size_t i, std::size_t count) {
  for (std::size_t c = 0; c < 3; ++c) store(a[c], f + c * count + i);
}

void svd3_of_arrays(const double* f, Svd3Arrays result, std::size_t count) {
  for (std::size_t i = 0; i < count; i += lanes_v<Pack>) {
    const Svd3<Pack> svd = svd3(load_matrix(f, i, count));
    store_matrix(svd.u, result.u, i, count);
    store_vector(svd.sigma, result.sigma, i, count);
    store_matrix(svd.v, result.v, i, count);
  }
}

/// Largest entry of isotropic_tensor(p) − U diag(p) Vᵀ, U and V from the same stages, for an arbitrary p.
Pack disagreement(const Deflation<Pack>& d) {
  const Vec3<Pack> p{Pack(0.75), Pack(-0.5), Pack(1.25)};
  const auto is_largest = d.root > Pack(0);
  const Vec3<Pack> sorted{select(is_largest, p[0], p[1]), select(is_largest, p[1], p[2]),
                          select(is_largest, p[2], p[0])};
  const Svd3<Pack> svd = assemble_svd3(d);
  const Mat3<Pack> difference = isotropic_tensor(d, p) - times_transpose(svd.u * diagonal(sorted), svd.v);
  Pack largest = Pack(0);
  for (std::size_t c = 0; c < 9; ++c) largest = max(abs(difference(c % 3, c / 3)), largest);
  return largest;
}

void isotropic_of_arrays(const double* f, IsotropicArrays result, std::size_t count) {
  for (std::size_t i = 0; i < count; i += lanes_v<Pack>) {
    const Deflation<Pack> d = deflate(load_matrix(f, i, count));
    const Vec3<Pack> stretches = principal_stretches(d);
    store_vector(stretches, result.stretches, i, count);
    store_matrix(isotropic_tensor(d, stretches), result.tensor, i, count);
    store_matrix(polar_rotation(d), result.rotation, i, count);
    store(disagreement(d), result.disagreement + i);
  }
}

constexpr LevelKernels level_kernels{EVERT_STRING(EVERT_KERNEL_LEVEL),
                                     lanes_v<Pack>,
                                     lanes_v<FloatPack>,
                                     operate<Pack>,
                                     operate<FloatPack>,
                                     svd3_of_arrays,
                                     isotropic_of_arrays};

}  // namespace

const LevelKernels& kernels() { return level_kernels; }

}  // namespace evert::test::EVERT_KERNEL_LEVEL
