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

LOAM_FN long long atomic_add(long long *address, long long amount) {
#if defined(__CUDA_ARCH__)
  return static_cast<long long>(
      atomicAdd(reinterpret_cast<unsigned long long *>(address), static_cast<unsigned long long>(amount)));
#else
  return std::atomic_ref<long long>(*address).fetch_add(amount, std::memory_order_relaxed);
#endif
}

} // namespace loam
