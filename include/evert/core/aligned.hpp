#pragma once
#include <cstddef>
#include <vector>

namespace evert {

/// Memory for arrays that SIMD code reads: aligned to 64 bytes, one cache line and the widest register. From
/// a MiB on it asks for huge pages (2 MiB), where the system grants them on request: one entry of the TLB
/// then spans what 512 did. Throws std::bad_alloc.
[[nodiscard]] void* allocate_aligned(std::size_t bytes);
/// Takes back what allocate_aligned(bytes) gave.
void free_aligned(void* memory, std::size_t bytes) noexcept;

/// The same for containers.
template <class T>
struct AlignedAllocator {
  using value_type = T;

  AlignedAllocator() = default;
  template <class U>
  explicit AlignedAllocator(const AlignedAllocator<U>& /*other*/) {}

  [[nodiscard]] T* allocate(std::size_t n) { return static_cast<T*>(allocate_aligned(n * sizeof(T))); }
  void deallocate(T* p, std::size_t n) noexcept { free_aligned(p, n * sizeof(T)); }
  template <class U>
  struct rebind {
    using other = AlignedAllocator<U>;
  };
  friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) = default;
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace evert
