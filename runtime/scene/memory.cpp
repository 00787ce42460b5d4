#include "scene/memory.h"

#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include "scene/error.h"

namespace loam {

namespace {

// Large arrays ask for large pages: a substep streams through all of them, and with pages of 4 KiB that is an address lookup for every ten particles.
constexpr std::size_t large_page = std::size_t(2) << 20;

std::size_t alignment_of(std::size_t bytes) { return bytes >= 2 * large_page ? large_page : HostAllocator::alignment; }

void *allocate_pages(std::size_t bytes) {
  void *memory = ::operator new(bytes, std::align_val_t(alignment_of(bytes)), std::nothrow);
#if defined(__linux__)
  // Only advice: where the system has no large pages nothing changes.
  if (memory != nullptr && bytes >= 2 * large_page) (void)madvise(memory, bytes / large_page * large_page, MADV_HUGEPAGE);
#endif
  return memory;
}

} // namespace

void *HostAllocator::allocate(std::size_t bytes) const {
  if (bytes == 0) bytes = alignment;
  void *memory = nullptr;
  if (hooks_.allocate != nullptr) {
    memory = hooks_.allocate(hooks_.user, bytes, alignment);
  } else {
    memory = allocate_pages(bytes);
  }
  if (memory == nullptr) throw Error(LOAM_ERROR_OUT_OF_MEMORY, format("the allocator refused %zu bytes", bytes));
  return memory;
}

void HostAllocator::release(void *memory, std::size_t bytes) const noexcept {
  if (bytes == 0) bytes = alignment;
  if (hooks_.release != nullptr) {
    hooks_.release(hooks_.user, memory, bytes, alignment);
  } else {
    ::operator delete(memory, std::align_val_t(alignment_of(bytes)), std::nothrow);
  }
}

} // namespace loam
