// Sort and prefix sum on the device, by CUB. Twin of cpu/radix_sort.h.
#pragma once

#include <cstdint>

#include "device_array.h"
#include "order_stages.h"

namespace loam {

class DeviceSort {
public:
  explicit DeviceSort(CudaDevice &device) : device_(device), keys_(device), values_(device), work_(device) {}
  void reserve(std::size_t count);
  // Stable, in place, by the low bits of the key: key < 2^key_bits.
  void sort(std::uint32_t *keys, std::uint32_t *values, int count, int key_bits) {
    sort_pairs(keys, values, count, key_bits);
  }
  void sort(std::uint64_t *keys, std::uint32_t *values, int count, int key_bits) {
    sort_pairs(keys, values, count, key_bits);
  }
  // In place: each element becomes the sum of those before it.
  void exclusive_sum(VisitSums *values, int count);
  std::size_t bytes() const { return keys_.bytes() + values_.bytes() + work_.bytes(); }

private:
  template <class Key> void sort_pairs(Key *keys, std::uint32_t *values, int count, int key_bits);

  CudaDevice &device_;
  DeviceArray<std::uint64_t> keys_; // room for keys of either size
  DeviceArray<std::uint32_t> values_;
  DeviceArray<std::uint64_t> work_;
};

} // namespace loam
