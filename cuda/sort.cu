#include "sort.h"

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

namespace loam {

namespace {

// CUB's calls come in pairs: the first only asks how much memory the second will work in.
template <class Call> void run(DeviceArray<std::uint64_t> &work, const char *what, Call &&call) {
  std::size_t bytes = 0;
  check_cuda(call(nullptr, bytes), what);
  work.reserve(bytes / sizeof(std::uint64_t) + 1);
  bytes = work.bytes();
  check_cuda(call(work.data(), bytes), what);
}

} // namespace

void DeviceSort::reserve(std::size_t count) {
  keys_.reserve(count);
  values_.reserve(count);
}

template <class Key> void DeviceSort::sort_pairs(Key *keys, std::uint32_t *values, int count, int key_bits) {
  if (count == 0) return;
  const CurrentDevice current(device_.number());
  cub::DoubleBuffer<Key> key_buffers(keys, reinterpret_cast<Key *>(keys_.data()));
  cub::DoubleBuffer<std::uint32_t> value_buffers(values, values_.data());
  run(work_, "sorting", [&](void *work, std::size_t &bytes) {
    return cub::DeviceRadixSort::SortPairs(work, bytes, key_buffers, value_buffers, count, 0, key_bits, device_.stream());
  });
  const auto n = static_cast<std::size_t>(count);
  if (key_buffers.Current() != keys) device_.copy(keys, key_buffers.Current(), n * sizeof(Key));
  if (value_buffers.Current() != values) device_.copy(values, value_buffers.Current(), n * sizeof(std::uint32_t));
}

template void DeviceSort::sort_pairs(std::uint32_t *, std::uint32_t *, int, int);
template void DeviceSort::sort_pairs(std::uint64_t *, std::uint32_t *, int, int);

void DeviceSort::exclusive_sum(VisitSums *values, int count) {
  if (count == 0) return;
  const CurrentDevice current(device_.number());
  run(work_, "summing", [&](void *work, std::size_t &bytes) {
    return cub::DeviceScan::ExclusiveScan(work, bytes, values, values, AddVisitSums(), VisitSums{0, 0, 0}, count,
                                          device_.stream());
  });
}

} // namespace loam
