#include "evert/core/aligned.hpp"

#include "evert/core/memory_in_use.hpp"

#include <atomic>
#include <cstdint>
#include <malloc.h>
#include <new>
#include <sys/mman.h>

namespace evert {
namespace {

constexpr std::align_val_t cache_line{64};
constexpr std::size_t huge_page = std::size_t{1} << 21;
/// Arrays half as large as a huge page get a whole one: what that wastes is less than what misses cost.
constexpr std::size_t worth_a_huge_page = huge_page / 2;

std::atomic<std::size_t> mapped_bytes = 0;

std::size_t whole_pages(std::size_t bytes) { return (bytes + huge_page - 1) / huge_page * huge_page; }

/// Fresh from the system: the heap hands out memory that has small pages already, which stay.
void* map_huge_pages(std::size_t bytes) {
  const std::size_t size = whole_pages(bytes);
  const std::size_t reserved = size + huge_page;
  void* const mapped = mmap(nullptr, reserved, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  char* const begin = static_cast<char*>(mapped);
  const std::size_t before = (huge_page - reinterpret_cast<std::uintptr_t>(begin) % huge_page) % huge_page;
  char* const array = begin + before;
  if (before > 0) static_cast<void>(munmap(begin, before));
  static_cast<void>(munmap(array + size, huge_page - before));
  static_cast<void>(madvise(array, size, MADV_HUGEPAGE));  // a wish: refused, the array is slower, no more
  mapped_bytes += size;
  return array;
}

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  return bytes < worth_a_huge_page ? ::operator new(bytes, cache_line) : map_huge_pages(bytes);
}

void free_aligned(void* memory, std::size_t bytes) noexcept {
  if (bytes < worth_a_huge_page) {
    ::operator delete(memory, cache_line);
  } else {
    static_cast<void>(munmap(memory, whole_pages(bytes)));
    mapped_bytes -= whole_pages(bytes);
  }
}

std::size_t memory_in_use() {
  const auto heap = mallinfo2();
  return heap.uordblks + heap.hblkhd + mapped_bytes;
}

}  // namespace evert
