/* The portable pack: every lane must do what the scalar text does, to the bit. That the other instruction sets agree with it is shown by the
 * determinism tests, over whole steps. */
#define LOAM_INSTRUCTION_SET pack_test
#define LOAM_PACK_WIDTH 4
#include "math/pack_portable.h"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "math/tensor_functions.h"
#include "support/tensors.h"

namespace loam {
namespace {

using pack_test::Mask;
using pack_test::Pack;
using test::RandomTensors;

struct Lanes {
  alignas(64) float value[Pack::width];
  explicit Lanes(const Pack &pack) { pack.store(value); }
  float operator[](int lane) const { return value[lane]; }
};

Pack pack_of(float a, float b, float c, float d) {
  alignas(64) const float values[4] = {a, b, c, d};
  return Pack::load(values);
}
std::uint32_t bits(float a) { return std::bit_cast<std::uint32_t>(a); }

TEST(Pack, ArithmeticIsThatOfTheLanes) {
  const float x[4] = {1.5f, -2.25f, 3e-20f, 1e20f}, y[4] = {0.3f, 7, -1e-10f, 2.5f};
  const Pack a = Pack::load_unaligned(x), b = Pack::load_unaligned(y);
  const Lanes sum(a + b), difference(a - b), product(a * b), quotient(a / b), root(square_root(absolute(a)));
  for (int l = 0; l < 4; ++l) {
    EXPECT_EQ(sum[l], x[l] + y[l]);
    EXPECT_EQ(difference[l], x[l] - y[l]);
    EXPECT_EQ(product[l], x[l] * y[l]);
    EXPECT_EQ(quotient[l], x[l] / y[l]);
    EXPECT_EQ(root[l], std::sqrt(std::fabs(x[l])));
  }
}

TEST(Pack, MasksAndSelectionTreatNaNAsScalarsDo) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float x[4] = {1, nan, 2, nan}, y[4] = {2, 1, nan, nan};
  const Pack a = Pack::load_unaligned(x), b = Pack::load_unaligned(y);
  const Lanes least(minimum(a, b)), most(maximum(a, b)), chosen(select(a < b, Pack(1.0f), Pack(0.0f)));
  for (int l = 0; l < 4; ++l) {
    EXPECT_EQ(bits(least[l]), bits(minimum(x[l], y[l])));
    EXPECT_EQ(bits(most[l]), bits(maximum(x[l], y[l])));
    EXPECT_EQ(chosen[l], x[l] < y[l] ? 1 : 0);
  }
  const Mask first = pack_of(0, 1, 1, 0) > Pack(0.5f), second = pack_of(0, 0, 1, 1) > Pack(0.5f);
  EXPECT_EQ(mask_bits(first), 0b0110u);
  EXPECT_EQ(mask_bits(both(first, second)), 0b0100u);
  EXPECT_EQ(mask_bits(either(first, second)), 0b1110u);
  EXPECT_EQ(mask_bits(opposite(first)), 0b1001u);
  EXPECT_EQ(count(first), 2);
  EXPECT_TRUE(any(first));
  EXPECT_FALSE(any(both(first, opposite(first))));
}

TEST(Pack, RowsAreLoadedAndStoredByIndex) {
  Row rows[8];
  for (int i = 0; i < 8; ++i) rows[i] = {float(i), float(10 * i), float(100 * i), float(1000 * i)};
  const int index[4] = {6, 1, 3, 0};
  const Vec4<Pack> v = pack_test::load_rows(rows, index);
  const Lanes x(v.x), w(v.w);
  for (int l = 0; l < 4; ++l) {
    EXPECT_EQ(x[l], float(index[l]));
    EXPECT_EQ(w[l], float(1000 * index[l]));
  }
  Row copy[8] = {};
  pack_test::store_rows(copy, index, v);
  for (const int i : index) {
    EXPECT_EQ(copy[i].y, rows[i].y);
    EXPECT_EQ(copy[i].z, rows[i].z);
  }
  EXPECT_EQ(copy[5].w, 0);
}

template <class T, class Get> Sym3<T> tensor(Get &&get) { return {get(0), get(1), get(2), get(3), get(4), get(5)}; }

/* One lane within the polynomials' range, one beyond, one at the clamp, one tiny: the mixed case of every branch that packs turn into a select. */
TEST(Pack, TensorFunctionsHaveTheBitsOfTheScalarText) {
  RandomTensors random(17);
  const double sizes[4] = {0.05, 0.4, 1.2, 1e-6};
  for (int k = 0; k < 500; ++k) {
    float S[4][6];
    for (int l = 0; l < 4; ++l) {
      const Sym3<float> s =
          test::narrow(test::apply(random.symmetric(random.vector(sizes[l])), [](double x) { return std::expm1(2 * x); }));
      const float values[6] = {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz};
      std::copy(values, values + 6, S[l]);
    }
    Sym3<Pack> packed = tensor<Pack>([&](int i) { return pack_of(S[0][i], S[1][i], S[2][i], S[3][i]); });
    Mask limited = Pack(0.0f) > Pack(0.0f);
    const HenckyStrain<Pack> strain = hencky_strain(packed, strain_limit(0.5), limited);
    const Sym3<Pack> back = expm1_traceless(strain.deviator);
    for (int l = 0; l < 4; ++l) {
      Sym3<float> one = tensor<float>([&](int i) { return S[l][i]; });
      bool one_limited = false;
      const HenckyStrain<float> expected = hencky_strain(one, strain_limit(0.5), one_limited);
      const Sym3<float> one_back = expm1_traceless(expected.deviator);
      EXPECT_EQ((mask_bits(limited) >> l & 1) != 0, one_limited);
      EXPECT_EQ(bits(Lanes(strain.trace)[l]), bits(expected.trace));
      EXPECT_EQ(bits(Lanes(strain.deviator.xy)[l]), bits(expected.deviator.xy));
      EXPECT_EQ(bits(Lanes(packed.yz)[l]), bits(one.yz));
      EXPECT_EQ(bits(Lanes(back.xx)[l]), bits(one_back.xx));
    }
  }
}

} // namespace
} // namespace loam
