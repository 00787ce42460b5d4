// A tile: W neighbouring threads of a warp that share the neighbours of one particle, a lane each. A lane's value is a plain float.
//
// The teams are written against this interface, so that their text also runs on a machine without a GPU, over a tile that is emulated.
// There a lane is one element of an array; hence `left`, how many lanes from the first still have an element of the list: threads beyond
// its end are not in the loop at all and need not look.
//
// Lanes leave a loop over neighbours after different numbers of rounds. Functions that need all lanes (sum, sync, bits_below) name the tile's
// threads, which makes them wait for each other; they must stand outside such loops.
#pragma once

#include "math/vector.h"

namespace loam {

template <int W> struct Tile {
  static_assert(W >= 1 && W <= 32 && (W & (W - 1)) == 0);
  static constexpr int width = W;
  using Lane = float;
  using Index = int; // a particle for each lane

  int lane;
  unsigned mask; // of the tile's threads within their warp

  __device__ __forceinline__ static Tile of_this_thread() {
    const unsigned all = W == 32 ? 0xffffffffu : (1u << (W % 32)) - 1u;
    return {static_cast<int>(threadIdx.x % W), all << (threadIdx.x % 32 / W * W)};
  }

  __device__ __forceinline__ int first_position() const { return lane; }
  __device__ __forceinline__ Index load_index(const int *place, int, int) const { return *place; }
  __device__ __forceinline__ Lane load(const float *place, int) const { return *place; }
  __device__ __forceinline__ void store(float *place, Lane value, int) const { *place = value; }
  __device__ __forceinline__ Vec4<Lane> gather(const Row *rows, Index k) const {
    const Row row = rows[k];
    return {row.x, row.y, row.z, row.w};
  }
  __device__ __forceinline__ void scatter(Row *rows, Index k, const Vec4<Lane> &v, int) const {
    rows[k] = {v.x, v.y, v.z, v.w};
  }
  __device__ __forceinline__ Lane gather_count(const int *counts, Index k) const { return static_cast<float>(counts[k]); }

  __device__ __forceinline__ Lane gather_lookup(const unsigned *numbers, const float *table, Index k) const {
    return table[numbers[k]];
  }

  // One thread writes what belongs to the particle.
  __device__ __forceinline__ bool leader() const { return lane == 0; }
  // Waits for the tile's threads, and makes what each has written visible to all.
  __device__ __forceinline__ void sync() const {
    if constexpr (W > 1) __syncwarp(mask);
  }
  // Sums over the lanes, which every lane receives with the same bits: each step adds the same two numbers on both sides. The addition is never
  // fused with a multiplication before it, which could round the two sides differently.
  template <int N> __device__ __forceinline__ void sum(float (&to)[N], const Lane (&from)[N]) const {
#pragma unroll
    for (int i = 0; i < N; ++i) to[i] = from[i];
#pragma unroll
    for (int distance = W / 2; distance > 0; distance /= 2)
#pragma unroll
      for (int i = 0; i < N; ++i) to[i] = __fadd_rn(to[i], __shfl_xor_sync(mask, to[i], distance, W));
  }

  // candidates: lane l stands for element base + l
  __device__ __forceinline__ Lane load_from(const float *values, int base) const { return values[base + lane]; }
  // Never fused: counting and filling, two kernels, must agree on every pair.
  __device__ __forceinline__ static Lane length_squared(Lane x, Lane y, Lane z) {
    return __fadd_rn(__fmul_rn(x, x), __fadd_rn(__fmul_rn(y, y), __fmul_rn(z, z)));
  }
  __device__ __forceinline__ unsigned bits_below(Lane value, float limit) const {
    return __ballot_sync(mask, value < limit) >> (threadIdx.x % 32 / W * W);
  }
  __device__ __forceinline__ static int count(unsigned bits) { return __popc(bits); }
  // Writes base + l for the set bits l, in order.
  __device__ __forceinline__ void append(int *end, unsigned bits, int base) const {
    if ((bits >> lane & 1u) != 0) end[__popc(bits & ((1u << lane) - 1u))] = base + lane;
  }
};

} // namespace loam
