#include "scene/memory.h"

#include <new>

#include "scene/error.h"

namespace loam {

void *HostAllocator::allocate(std::size_t bytes) const {
  if (bytes == 0) bytes = alignment;
  void *memory = nullptr;
  if (hooks_.allocate != nullptr) {
    memory = hooks_.allocate(hooks_.user, bytes, alignment);
  } else {
    memory = ::operator new(bytes, std::align_val_t(alignment), std::nothrow);
  }
  if (memory == nullptr) throw Error(LOAM_ERROR_OUT_OF_MEMORY, format("the allocator refused %zu bytes", bytes));
  return memory;
}

void HostAllocator::release(void *memory, std::size_t bytes) const noexcept {
  if (bytes == 0) bytes = alignment;
  if (hooks_.release != nullptr) {
    hooks_.release(hooks_.user, memory, bytes, alignment);
  } else {
    ::operator delete(memory, std::align_val_t(alignment), std::nothrow);
  }
}

} // namespace loam
