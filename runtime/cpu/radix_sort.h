// Stable radix sort of (key, value) pairs by the low bits of the key. Twin of the CUDA backend's.
#pragma once

#include <cstdint>

#include "cpu/workers.h"
#include "scene/memory.h"

namespace loam {

class RadixSort {
public:
  explicit RadixSort(const HostAllocator &allocator) : keys_(allocator), values_(allocator), histogram_(allocator) {}
  void reserve(std::size_t count);
  // Sorted in place; `key_bits` bounds the keys: key < 2^key_bits.
  void sort(Workers &workers, std::uint32_t *keys, std::uint32_t *values, int count, int key_bits);
  std::size_t bytes() const { return keys_.bytes() + values_.bytes() + histogram_.bytes(); }

private:
  static constexpr int digit_bits = 11, digits = 1 << digit_bits, max_chunks = 16;
  HostArray<std::uint32_t> keys_, values_;
  HostArray<int> histogram_; // [chunk][digit]
};

} // namespace loam
