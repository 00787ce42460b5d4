// Kernels over items: loops and reductions.
#pragma once

#include <algorithm>

#include "device_array.h"

namespace loam {

constexpr int item_threads = 256;

template <class Stage> __global__ void __launch_bounds__(item_threads, 1) each_item(const Stage stage, int count) {
  const int i = static_cast<int>(blockIdx.x * item_threads + threadIdx.x);
  if (i < count) stage(i);
}

template <class T> struct SetValue {
  T *values;
  T value;
  __device__ void operator()(int i) const { values[i] = value; }
};

// Reduces each chunk of items to one value. Which thread takes which item, and in what order values are combined, follows from the chunk's size
// alone: the same bits on every device.
template <class Reduction>
__global__ void __launch_bounds__(item_threads)
    reduce_chunks(const Reduction reduction, int count, int chunk, typename Reduction::Value *results) {
  using Value = typename Reduction::Value;
  __shared__ Value values[item_threads];
  const long long first = static_cast<long long>(blockIdx.x) * chunk;
  const long long last = first + chunk < count ? first + chunk : count;
  const int thread = static_cast<int>(threadIdx.x);
  Value value = Reduction::identity();
  for (long long i = first + thread; i < last; i += item_threads)
    value = Reduction::combine(value, reduction(static_cast<int>(i)));
  values[thread] = value;
  for (int half = item_threads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (thread < half) values[thread] = Reduction::combine(values[thread], values[thread + half]);
  }
  if (thread == 0) results[blockIdx.x] = values[0];
}

// The second round: a reduction over the results of the first.
template <class Reduction> struct CombineResults {
  using Value = typename Reduction::Value;
  const Value *results;
  __device__ static Value identity() { return Reduction::identity(); }
  __device__ Value operator()(int i) const { return results[i]; }
  __device__ static Value combine(const Value &a, const Value &b) { return Reduction::combine(a, b); }
};

} // namespace loam
