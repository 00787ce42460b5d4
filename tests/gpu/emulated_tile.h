// A tile of lanes on a machine without a GPU: the lanes are an array and run in lockstep. The CUDA teams are compiled against it, so their
// text, the layout of the lists and the folding of sums are executed by tests. Lane and Real are different types here, so a stage that
// takes one for the other does not compile.
#pragma once

#include <bit>

#include "math/vector.h"

namespace loam::emulation {

template <int W> struct Mask { bool lane[W]; };

template <int W> struct Floats {
  float lane[W];
  Floats() = default;
  Floats(float a) {
    for (float &l : lane) l = a;
  }
};

template <int W, class F> Floats<W> each(const Floats<W> &a, const Floats<W> &b, F &&f) {
  Floats<W> c;
  for (int l = 0; l < W; ++l) c.lane[l] = f(a.lane[l], b.lane[l]);
  return c;
}
template <int W, class F> Mask<W> test(const Floats<W> &a, const Floats<W> &b, F &&f) {
  Mask<W> c;
  for (int l = 0; l < W; ++l) c.lane[l] = f(a.lane[l], b.lane[l]);
  return c;
}
template <int W> Floats<W> operator+(const Floats<W> &a, const Floats<W> &b) {
  return each(a, b, [](float x, float y) { return x + y; });
}
template <int W> Floats<W> operator-(const Floats<W> &a, const Floats<W> &b) {
  return each(a, b, [](float x, float y) { return x - y; });
}
template <int W> Floats<W> operator*(const Floats<W> &a, const Floats<W> &b) {
  return each(a, b, [](float x, float y) { return x * y; });
}
template <int W> Floats<W> operator/(const Floats<W> &a, const Floats<W> &b) {
  return each(a, b, [](float x, float y) { return x / y; });
}
template <int W> Mask<W> operator>(const Floats<W> &a, const Floats<W> &b) {
  return test(a, b, [](float x, float y) { return x > y; });
}
template <int W> Mask<W> operator<(const Floats<W> &a, const Floats<W> &b) { return b > a; }
template <int W> Floats<W> maximum(const Floats<W> &a, const Floats<W> &b) {
  return each(a, b, [](float x, float y) { return loam::maximum(x, y); });
}
template <int W> Floats<W> square_root(const Floats<W> &a) {
  return each(a, a, [](float x, float) { return loam::square_root(x); });
}
template <int W> Floats<W> select(const Mask<W> &mask, const Floats<W> &a, const Floats<W> &b) {
  Floats<W> c;
  for (int l = 0; l < W; ++l) c.lane[l] = mask.lane[l] ? a.lane[l] : b.lane[l];
  return c;
}

// The interface of cuda/tile.cuh. Lanes beyond the end of a list stand on the particle itself, with gradient 0, and write nothing.
template <int W> struct Tile {
  static constexpr int width = W;
  using Lane = Floats<W>;
  struct Index {
    int lane[W];
  };

  int first_position() const { return 0; }
  static int in_use(int left) { return left < W ? left : W; }
  Index load_index(const int *place, int left, int self) const {
    Index index;
    for (int l = 0; l < W; ++l) index.lane[l] = l < left ? place[l] : self;
    return index;
  }
  Lane load(const float *place, int left) const {
    Lane value(0.0f);
    for (int l = 0; l < in_use(left); ++l) value.lane[l] = place[l];
    return value;
  }
  void store(float *place, const Lane &value, int left) const {
    for (int l = 0; l < in_use(left); ++l) place[l] = value.lane[l];
  }
  Vec4<Lane> gather(const Row *rows, const Index &k) const {
    Vec4<Lane> v;
    for (int l = 0; l < W; ++l) {
      const Row &row = rows[k.lane[l]];
      v.x.lane[l] = row.x;
      v.y.lane[l] = row.y;
      v.z.lane[l] = row.z;
      v.w.lane[l] = row.w;
    }
    return v;
  }
  void scatter(Row *rows, const Index &k, const Vec4<Lane> &v, int left) const {
    for (int l = 0; l < in_use(left); ++l) rows[k.lane[l]] = {v.x.lane[l], v.y.lane[l], v.z.lane[l], v.w.lane[l]};
  }
  Lane gather_count(const int *counts, const Index &k) const {
    Lane value;
    for (int l = 0; l < W; ++l) value.lane[l] = static_cast<float>(counts[k.lane[l]]);
    return value;
  }
  Lane gather_lookup(const std::uint32_t *numbers, const float *table, const Index &k) const {
    Lane value;
    for (int l = 0; l < W; ++l) value.lane[l] = table[numbers[k.lane[l]]];
    return value;
  }

  bool leader() const { return true; }
  void sync() const {}
  // Lane 0's sum; the others' has the same bits, because an addition does not depend on its sides.
  template <int N> void sum(float (&to)[N], const Lane (&from)[N]) const {
    for (int i = 0; i < N; ++i) {
      Lane value = from[i];
      for (int distance = W / 2; distance > 0; distance /= 2) {
        Lane other;
        for (int l = 0; l < W; ++l) other.lane[l] = value.lane[l ^ distance];
        value = value + other;
      }
      to[i] = value.lane[0];
    }
  }

  Lane load_from(const float *values, int base) const { return load(values + base, W); }
  static Lane length_squared(const Lane &x, const Lane &y, const Lane &z) { return x * x + (y * y + z * z); }
  unsigned bits_below(const Lane &value, float limit) const {
    unsigned bits = 0;
    for (int l = 0; l < W; ++l) bits |= value.lane[l] < limit ? 1u << l : 0u;
    return bits;
  }
  static int count(unsigned bits) { return std::popcount(bits); }
  void append(int *end, unsigned bits, int base) const {
    for (; bits != 0; bits &= bits - 1) *end++ = base + std::countr_zero(bits);
  }
};

// One thread: a lane is a float.
template <> struct Tile<1> {
  static constexpr int width = 1;
  using Lane = float;
  using Index = int;

  int first_position() const { return 0; }
  Index load_index(const int *place, int, int) const { return *place; }
  Lane load(const float *place, int) const { return *place; }
  void store(float *place, Lane value, int) const { *place = value; }
  Vec4<Lane> gather(const Row *rows, Index k) const { return {rows[k].x, rows[k].y, rows[k].z, rows[k].w}; }
  void scatter(Row *rows, Index k, const Vec4<Lane> &v, int) const { rows[k] = {v.x, v.y, v.z, v.w}; }
  Lane gather_count(const int *counts, Index k) const { return static_cast<float>(counts[k]); }
  Lane gather_lookup(const std::uint32_t *numbers, const float *table, Index k) const { return table[numbers[k]]; }
  bool leader() const { return true; }
  void sync() const {}
  template <int N> void sum(float (&to)[N], const Lane (&from)[N]) const {
    for (int i = 0; i < N; ++i) to[i] = from[i];
  }
};

} // namespace loam::emulation
