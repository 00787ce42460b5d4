// Integer atomics for kernels. There are no float atomics: their order would change the bits of a result.
#pragma once

#include "math/qualifiers.h"

#if !defined(__CUDA_ARCH__)
#include <atomic>
#endif

namespace loam {

// Adds and returns the value before.
LOAM_FN int atomic_add(int *address, int amount) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(address, amount);
#else
  return std::atomic_ref<int>(*address).fetch_add(amount, std::memory_order_relaxed);
#endif
}

} // namespace loam
