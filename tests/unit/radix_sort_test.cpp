#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <vector>

#include "cpu/radix_sort.h"

namespace loam {
namespace {

void expect_sorted_stably(unsigned threads, int count, int key_bits, std::uint32_t distinct) {
  Workers workers(threads, {});
  const HostAllocator allocator;
  RadixSort sort(allocator);
  sort.reserve(std::size_t(count));
  std::mt19937 random(unsigned(count + key_bits));
  std::vector<std::uint32_t> keys(std::size_t(count) + 1), values(std::size_t(count) + 1),
      order(static_cast<std::size_t>(count));
  for (std::uint32_t &key : keys) key = (random() % distinct) & ((std::uint64_t(1) << key_bits) - 1);
  std::iota(values.begin(), values.end(), 0u);
  std::iota(order.begin(), order.end(), 0u);
  const std::vector<std::uint32_t> before = keys;
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return before[a] < before[b]; });
  workers.session([&] { sort.sort(workers, keys.data(), values.data(), count, key_bits); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    ASSERT_EQ(values[i], order[i]) << i;
    ASSERT_EQ(keys[i], before[order[i]]) << i;
  }
  EXPECT_EQ(keys.back(), before.back()); // nothing past the end
}

TEST(RadixSort, AgreesWithAStableSort) {
  for (const unsigned threads : {1u, 4u})
    for (const int key_bits : {1, 5, 11, 12, 17, 22, 23, 30, 32})
      for (const int count : {0, 1, 2, 1000, 8191, 100000}) expect_sorted_stably(threads, count, key_bits, 0xffffffffu);
}

TEST(RadixSort, KeepsTheOrderOfEqualKeys) {
  for (const std::uint32_t distinct : {1u, 2u, 7u}) expect_sorted_stably(4, 50000, 20, distinct);
}

} // namespace
} // namespace loam
