// Pack: one SIMD register of floats, by Highway, for the instruction set that this translation unit is compiled for.
//
// The build compiles the kernels once per instruction set, each with LOAM_INSTRUCTION_SET naming its own namespace and LOAM_PACK_WIDTH its
// number of lanes. Everything here is always inlined and lives in that namespace, so that no symbol is shared between the copies.
#pragma once

#include <hwy/highway.h>
#include <type_traits>

#include "math/matrix.h"

namespace loam::LOAM_INSTRUCTION_SET {

namespace hn = hwy::HWY_NAMESPACE;
using FloatTag = hn::CappedTag<float, LOAM_PACK_WIDTH>;
using BlockTag = hn::CappedTag<float, 4>; // one row
using NativePack = hn::Vec<FloatTag>;
using NativeMask = hn::Mask<FloatTag>;

struct Mask {
  NativeMask native;
};

struct Pack {
  static constexpr int width = LOAM_PACK_WIDTH;
  NativePack native;
  LOAM_FN Pack() = default;
  LOAM_FN Pack(NativePack n) : native(n) {}
  LOAM_FN Pack(float a) : native(hn::Set(FloatTag(), a)) {}
  static LOAM_FN Pack load(const float *p) { return hn::Load(FloatTag(), p); }
  static LOAM_FN Pack load_unaligned(const float *p) { return hn::LoadU(FloatTag(), p); }
  LOAM_FN void store(float *p) const { hn::Store(native, FloatTag(), p); }
};

LOAM_FN Pack operator+(Pack a, Pack b) { return hn::Add(a.native, b.native); }
LOAM_FN Pack operator-(Pack a, Pack b) { return hn::Sub(a.native, b.native); }
LOAM_FN Pack operator*(Pack a, Pack b) { return hn::Mul(a.native, b.native); }
LOAM_FN Pack operator/(Pack a, Pack b) { return hn::Div(a.native, b.native); }
LOAM_FN Mask operator<(Pack a, Pack b) { return {hn::Lt(a.native, b.native)}; }
LOAM_FN Mask operator<=(Pack a, Pack b) { return {hn::Le(a.native, b.native)}; }
LOAM_FN Mask operator>(Pack a, Pack b) { return {hn::Gt(a.native, b.native)}; }
LOAM_FN Mask operator>=(Pack a, Pack b) { return {hn::Ge(a.native, b.native)}; }
LOAM_FN Pack square_root(Pack a) { return hn::Sqrt(a.native); }
LOAM_FN Pack absolute(Pack a) { return hn::Abs(a.native); }
LOAM_FN Pack select(Mask m, Pack a, Pack b) { return hn::IfThenElse(m.native, a.native, b.native); }
// The scalar definitions to the letter, also for NaN.
LOAM_FN Pack minimum(Pack a, Pack b) { return select(a < b, a, b); }
LOAM_FN Pack maximum(Pack a, Pack b) { return select(a > b, a, b); }
LOAM_FN Mask both(Mask a, Mask b) { return {hn::And(a.native, b.native)}; }
LOAM_FN Mask either(Mask a, Mask b) { return {hn::Or(a.native, b.native)}; }
LOAM_FN Mask opposite(Mask a) { return {hn::Not(a.native)}; }
LOAM_FN Pack power_of_two(Pack n) {
  const hn::RebindToSigned<FloatTag> tag;
  return hn::BitCast(FloatTag(), hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(tag, n.native), hn::Set(tag, 127))));
}
LOAM_FN Pack binary_exponent(Pack a) {
  const hn::RebindToSigned<FloatTag> tag;
  return hn::ConvertTo(FloatTag(), hn::ShiftRight<23>(hn::Sub(hn::BitCast(tag, a.native), hn::Set(tag, 0x3f3504f3))));
}
LOAM_FN bool any(Mask m) { return !hn::AllFalse(FloatTag(), m.native); }
LOAM_FN int count(Mask m) { return static_cast<int>(hn::CountTrue(FloatTag(), m.native)); }
// Bit l is lane l.
LOAM_FN unsigned mask_bits(Mask m) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(FloatTag(), m.native, bytes);
  if constexpr (Pack::width != 16) return bytes[0];
  std::uint16_t word;
  __builtin_memcpy(&word, bytes, sizeof word);
  return word;
}

// For the neighbour search, on indices of the lanes' candidates: of `among` those that are not `self`.
LOAM_FN Mask others(const int *index, int self, Mask among) {
  const hn::RebindToSigned<FloatTag> tag;
  const auto same = hn::Eq(hn::Load(tag, index), hn::Set(tag, self));
  return {hn::AndNot(hn::RebindMask(FloatTag(), same), among.native)};
}
// Of `among` those whose pair with `self` belongs to self.
LOAM_FN Mask owned_pairs(const int *index, int self, Mask among) {
  const hn::RebindToSigned<FloatTag> tag;
  const auto other = hn::Load(tag, index), own = hn::Set(tag, self), one = hn::Set(tag, 1);
  const auto even_sum = hn::Eq(hn::And(hn::Xor(other, own), one), hn::Zero(tag));
  const auto above = hn::Gt(other, own);
  return {hn::AndNot(hn::RebindMask(FloatTag(), hn::Xor(even_sum, above)), among.native)};
}
// A pack of them, from an aligned place to any.
LOAM_FN void copy_pack(const int *from, int *to) {
  const hn::RebindToSigned<FloatTag> tag;
  hn::StoreU(hn::Load(tag, from), tag, to);
  __asm__ volatile("" : : : "memory"); // or a loop of these becomes a call for copying memory, slower by far
}
// first, first + 1, ...
LOAM_FN void store_sequence(int *to, int first) {
  const hn::RebindToSigned<FloatTag> tag;
  hn::StoreU(hn::Add(hn::Iota(tag, 0), hn::Set(tag, first)), tag, to);
}

// Copies the entries of the lanes in `mask` to `to`, one after the other; up to a pack of others behind them. Returns how many.
LOAM_FN int compress(const int *from, Mask mask, int *to) {
  if constexpr (Pack::width == 16) {
    const hn::RebindToSigned<FloatTag> tag;
    hn::StoreU(hn::Compress(hn::Load(tag, from), hn::RebindMask(tag, mask.native)), tag, to);
    return count(mask);
  } else { // without an instruction for it, one by one is faster
    const int *const begin = to;
    for (unsigned bits = mask_bits(mask); bits != 0; bits &= bits - 1) *to++ = from[__builtin_ctz(bits)];
    return static_cast<int>(to - begin);
  }
}

// Four registers of rows: register a holds, in its 128-bit block q, the row index[a + 4 q]; after the transposition within blocks, lane l
// belongs to index[l].
template <int First> LOAM_FN NativePack load_blocks(const float *rows, const int *index) {
  const auto block = [&](int q) {
    return hn::Load(BlockTag(), rows + 4 * static_cast<std::ptrdiff_t>(index[First + 4 * q]));
  };
#if LOAM_PACK_WIDTH == 16
  const hn::CappedTag<float, 8> half;
  return hn::Combine(FloatTag(), hn::Combine(half, block(3), block(2)), hn::Combine(half, block(1), block(0)));
#elif LOAM_PACK_WIDTH == 8
  return hn::Combine(FloatTag(), block(1), block(0));
#else
  return block(0);
#endif
}
template <int First> LOAM_FN void store_blocks(float *rows, const int *index, NativePack v) {
  const auto store = [&](int q, auto block) {
    hn::Store(block, BlockTag(), rows + 4 * static_cast<std::ptrdiff_t>(index[First + 4 * q]));
  };
#if LOAM_PACK_WIDTH == 16
  const hn::CappedTag<float, 8> half;
  const auto low = hn::LowerHalf(half, v), high = hn::UpperHalf(half, v);
  store(0, hn::LowerHalf(BlockTag(), low));
  store(1, hn::UpperHalf(BlockTag(), low));
  store(2, hn::LowerHalf(BlockTag(), high));
  store(3, hn::UpperHalf(BlockTag(), high));
#elif LOAM_PACK_WIDTH == 8
  store(0, hn::LowerHalf(BlockTag(), v));
  store(1, hn::UpperHalf(BlockTag(), v));
#else
  store(0, v);
#endif
}
// 4x4 transposition within each 128-bit block.
LOAM_FN void transpose_blocks(NativePack &a, NativePack &b, NativePack &c, NativePack &d) {
  const FloatTag tag;
  const hn::RepartitionToWide<hn::RebindToUnsigned<FloatTag>> wide;
  const auto join_low = [&](NativePack u, NativePack v) {
    return hn::BitCast(tag, hn::InterleaveLower(wide, hn::BitCast(wide, u), hn::BitCast(wide, v)));
  };
  const auto join_high = [&](NativePack u, NativePack v) {
    return hn::BitCast(tag, hn::InterleaveUpper(wide, hn::BitCast(wide, u), hn::BitCast(wide, v)));
  };
  const NativePack ab_low = hn::InterleaveLower(tag, a, b), ab_high = hn::InterleaveUpper(tag, a, b);
  const NativePack cd_low = hn::InterleaveLower(tag, c, d), cd_high = hn::InterleaveUpper(tag, c, d);
  a = join_low(ab_low, cd_low);
  b = join_high(ab_low, cd_low);
  c = join_low(ab_high, cd_high);
  d = join_high(ab_high, cd_high);
}

// Entries `first` to `first` + 3 of each lane's list, as bits.
LOAM_FN Vec4<Pack> load_columns(const int *const *lists, int first) {
  const auto load = [&](auto begin) {
    const auto block = [&](int q) {
      return hn::LoadU(BlockTag(), reinterpret_cast<const float *>(lists[begin.value + 4 * q] + first));
    };
#if LOAM_PACK_WIDTH == 16
    const hn::CappedTag<float, 8> half;
    return hn::Combine(FloatTag(), hn::Combine(half, block(3), block(2)), hn::Combine(half, block(1), block(0)));
#elif LOAM_PACK_WIDTH == 8
    return hn::Combine(FloatTag(), block(1), block(0));
#else
    return block(0);
#endif
  };
  NativePack a = load(std::integral_constant<int, 0>()), b = load(std::integral_constant<int, 1>()),
             c = load(std::integral_constant<int, 2>()), d = load(std::integral_constant<int, 3>());
  transpose_blocks(a, b, c, d);
  return {a, b, c, d};
}
LOAM_FN Vec4<Pack> load_rows(const Row *rows, const int *index) {
  const float *base = &rows->x;
  NativePack a = load_blocks<0>(base, index), b = load_blocks<1>(base, index), c = load_blocks<2>(base, index),
             d = load_blocks<3>(base, index);
  transpose_blocks(a, b, c, d);
  return {a, b, c, d};
}
LOAM_FN void store_rows(Row *rows, const int *index, const Vec4<Pack> &v) {
  float *base = &rows->x;
  NativePack a = v.x.native, b = v.y.native, c = v.z.native, d = v.w.native;
  transpose_blocks(a, b, c, d);
  store_blocks<0>(base, index, a);
  store_blocks<1>(base, index, b);
  store_blocks<2>(base, index, c);
  store_blocks<3>(base, index, d);
}

} // namespace loam::LOAM_INSTRUCTION_SET
