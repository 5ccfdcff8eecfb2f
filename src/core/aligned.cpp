#include "evert/core/aligned.hpp"

#include <new>
#include <sys/mman.h>

namespace evert {
namespace {

constexpr std::size_t cache_line = 64;
constexpr std::size_t huge_page = std::size_t{1} << 21;
/// Arrays half as large as a huge page get a whole one: what that wastes is less than what misses cost.
constexpr std::size_t worth_a_huge_page = huge_page / 2;

std::align_val_t alignment_of(std::size_t bytes) {
  return std::align_val_t{bytes >= worth_a_huge_page ? huge_page : cache_line};
}

std::size_t whole_pages(std::size_t bytes) { return (bytes + huge_page - 1) / huge_page * huge_page; }

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  if (bytes < worth_a_huge_page) return ::operator new(bytes, alignment_of(bytes));
  void* memory = ::operator new(whole_pages(bytes), alignment_of(bytes));
  static_cast<void>(madvise(memory, whole_pages(bytes), MADV_HUGEPAGE));  // a wish; refusal costs speed only
  return memory;
}

void free_aligned(void* memory, std::size_t bytes) noexcept {
  ::operator delete(memory, alignment_of(bytes));
}

}  // namespace evert
