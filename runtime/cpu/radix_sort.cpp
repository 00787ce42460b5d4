#include "cpu/radix_sort.h"

#include <algorithm>
#include <cstring>

namespace loam {

void RadixSort::reserve(std::size_t count) {
  keys_.reserve(count);
  values_.reserve(count);
  histogram_.reserve(static_cast<std::size_t>(max_chunks) * digits);
}

void RadixSort::sort(Workers &workers, std::uint32_t *keys, std::uint32_t *values, int count, int key_bits) {
  // The result of a stable sort does not depend on how the work is cut into chunks.
  const int chunks = std::clamp(count / 8192, 1, max_chunks);
  const auto chunk_begin = [&](int c) { return static_cast<int>(static_cast<std::int64_t>(count) * c / chunks); };
  std::uint32_t *from_keys = keys, *from_values = values, *to_keys = keys_.data(), *to_values = values_.data();
  for (int shift = 0; shift < key_bits; shift += digit_bits) {
    const int used = 1 << std::min(digit_bits, key_bits - shift);
    const auto digit = [&](std::uint32_t key) {
      return static_cast<int>((key >> shift) & static_cast<unsigned>(digits - 1));
    };
    workers.loop(chunks, [&](int c) {
      int *counts = &histogram_[static_cast<std::size_t>(c) * digits];
      std::memset(counts, 0, static_cast<std::size_t>(used) * sizeof(int));
      for (int i = chunk_begin(c); i < chunk_begin(c + 1); ++i) ++counts[digit(from_keys[i])];
    });
    int sum = 0;
    for (int d = 0; d < used; ++d)
      for (int c = 0; c < chunks; ++c) {
        int &entry = histogram_[static_cast<std::size_t>(c) * digits + static_cast<std::size_t>(d)];
        const int next = sum + entry;
        entry = sum;
        sum = next;
      }
    workers.loop(chunks, [&](int c) {
      int *places = &histogram_[static_cast<std::size_t>(c) * digits];
      for (int i = chunk_begin(c); i < chunk_begin(c + 1); ++i) {
        const int place = places[digit(from_keys[i])]++;
        to_keys[place] = from_keys[i];
        to_values[place] = from_values[i];
      }
    });
    std::swap(from_keys, to_keys);
    std::swap(from_values, to_values);
  }
  if (from_keys != keys && count > 0) {
    workers.loop(chunks, [&](int c) {
      const int first = chunk_begin(c), length = chunk_begin(c + 1) - first;
      std::memcpy(keys + first, from_keys + first, static_cast<std::size_t>(length) * sizeof(std::uint32_t));
      std::memcpy(values + first, from_values + first, static_cast<std::size_t>(length) * sizeof(std::uint32_t));
    });
  }
}

} // namespace loam
