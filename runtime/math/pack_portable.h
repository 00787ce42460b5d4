// Pack for machines without a Highway target of our list: four lanes in the compiler's generic vectors, whatever the processor is.
// The same interface and the same bits as math/pack.h.
#pragma once

#include <cmath>

#include "math/matrix.h"

namespace loam::LOAM_INSTRUCTION_SET {

using NativePack = float __attribute__((vector_size(16)));
using NativeMask = int __attribute__((vector_size(16)));

struct Mask {
  NativeMask native;
};

struct Pack {
  static constexpr int width = 4;
  NativePack native;
  LOAM_FN Pack() = default;
  LOAM_FN Pack(NativePack n) : native(n) {}
  LOAM_FN Pack(float a) : native{a, a, a, a} {}
  static LOAM_FN Pack load(const float *p) { return NativePack{p[0], p[1], p[2], p[3]}; }
  static LOAM_FN Pack load_unaligned(const float *p) { return load(p); }
  LOAM_FN void store(float *p) const {
    for (int l = 0; l < 4; ++l) p[l] = native[l];
  }
};

LOAM_FN Pack operator+(Pack a, Pack b) { return a.native + b.native; }
LOAM_FN Pack operator-(Pack a, Pack b) { return a.native - b.native; }
LOAM_FN Pack operator*(Pack a, Pack b) { return a.native * b.native; }
LOAM_FN Pack operator/(Pack a, Pack b) { return a.native / b.native; }
LOAM_FN Mask operator<(Pack a, Pack b) { return {a.native < b.native}; }
LOAM_FN Mask operator<=(Pack a, Pack b) { return {a.native <= b.native}; }
LOAM_FN Mask operator>(Pack a, Pack b) { return {a.native > b.native}; }
LOAM_FN Mask operator>=(Pack a, Pack b) { return {a.native >= b.native}; }
LOAM_FN Pack square_root(Pack a) {
  return NativePack{sqrtf(a.native[0]), sqrtf(a.native[1]), sqrtf(a.native[2]), sqrtf(a.native[3])};
}
LOAM_FN Pack absolute(Pack a) {
  return NativePack{fabsf(a.native[0]), fabsf(a.native[1]), fabsf(a.native[2]), fabsf(a.native[3])};
}
LOAM_FN Pack select(Mask m, Pack a, Pack b) { return m.native ? a.native : b.native; }
LOAM_FN Pack minimum(Pack a, Pack b) { return select(a < b, a, b); }
LOAM_FN Pack maximum(Pack a, Pack b) { return select(a > b, a, b); }
LOAM_FN Mask both(Mask a, Mask b) { return {a.native & b.native}; }
LOAM_FN Mask either(Mask a, Mask b) { return {a.native | b.native}; }
LOAM_FN Mask opposite(Mask a) { return {~a.native}; }
LOAM_FN Pack power_of_two(Pack n) {
  return reinterpret_cast<NativePack>((__builtin_convertvector(n.native, NativeMask) + 127) * (1 << 23));
}
LOAM_FN Pack binary_exponent(Pack a) {
  return __builtin_convertvector((reinterpret_cast<NativeMask>(a.native) - 0x3f3504f3) >> 23, NativePack);
}
LOAM_FN bool any(Mask m) { return (m.native[0] | m.native[1] | m.native[2] | m.native[3]) != 0; }
LOAM_FN int count(Mask m) { return -(m.native[0] + m.native[1] + m.native[2] + m.native[3]); }
LOAM_FN unsigned mask_bits(Mask m) {
  unsigned bits = 0;
  for (int l = 0; l < 4; ++l) bits |= m.native[l] != 0 ? 1u << l : 0u;
  return bits;
}

// For the neighbour search, as in math/pack.h.
LOAM_FN Mask others(const int *index, int self, Mask among) {
  for (int l = 0; l < 4; ++l)
    if (index[l] == self) among.native[l] = 0;
  return among;
}
LOAM_FN Mask owned_pairs(const int *index, int self, Mask among) {
  for (int l = 0; l < 4; ++l)
    if ((self < index[l]) != (((index[l] ^ self) & 1) == 0)) among.native[l] = 0;
  return among;
}
LOAM_FN void copy_pack(const int *from, int *to) {
  for (int l = 0; l < 4; ++l) to[l] = from[l];
}
LOAM_FN void store_sequence(int *to, int first) {
  for (int l = 0; l < 4; ++l) to[l] = first + l;
}
LOAM_FN int compress(const int *from, Mask mask, int *to) {
  const int *const begin = to;
  for (int l = 0; l < 4; ++l)
    if (mask.native[l] != 0) *to++ = from[l];
  return static_cast<int>(to - begin);
}

LOAM_FN Vec4<Pack> load_columns(const int *const *lists, int first) {
  NativePack column[4];
  for (int k = 0; k < 4; ++k) {
    const NativeMask entries = {lists[0][first + k], lists[1][first + k], lists[2][first + k], lists[3][first + k]};
    column[k] = reinterpret_cast<NativePack>(entries);
  }
  return {column[0], column[1], column[2], column[3]};
}
LOAM_FN Vec4<Pack> load_rows(const Row *rows, const int *index) {
  const Row &a = rows[index[0]], &b = rows[index[1]], &c = rows[index[2]], &d = rows[index[3]];
  return {NativePack{a.x, b.x, c.x, d.x}, NativePack{a.y, b.y, c.y, d.y}, NativePack{a.z, b.z, c.z, d.z},
          NativePack{a.w, b.w, c.w, d.w}};
}
LOAM_FN void store_rows(Row *rows, const int *index, const Vec4<Pack> &v) {
  for (int l = 0; l < 4; ++l) rows[index[l]] = {v.x.native[l], v.y.native[l], v.z.native[l], v.w.native[l]};
}

} // namespace loam::LOAM_INSTRUCTION_SET
