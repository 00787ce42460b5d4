/* The portable pack: every lane must do what the scalar text does, to the bit. That the other instruction sets agree with it is shown by the
 * determinism tests, over whole steps. */
#define LOAM_INSTRUCTION_SET pack_test
#define LOAM_PACK_WIDTH 4
#include "math/pack_portable.h"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "kernels/inelastic/kinematics.h"
#include "kernels/materials/project.h"
#include "math/tensor_functions.h"
#include "scene/material.h"
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

TEST(Pack, ElementaryFunctionsHaveTheBitsOfTheScalarText) {
  RandomTensors random(19);
  for (int k = 0; k < 2000; ++k) {
    float x[4];
    for (float &value : x) value = float(random.between(-90, 90));
    const Pack a = Pack::load_unaligned(x);
    const Lanes power(exponential(a)), logarithms(logarithm(absolute(a))), exponent(binary_exponent(exponential(a)));
    const Lanes sine(sinh_to_two(absolute(a) * Pack(0.02f))), cosine(cosine_of_third(absolute(a) * Pack(0.01f)));
    for (int l = 0; l < 4; ++l) {
      EXPECT_EQ(bits(power[l]), bits(exponential(x[l])));
      EXPECT_EQ(bits(logarithms[l]), bits(logarithm(std::fabs(x[l]))));
      EXPECT_EQ(exponent[l], binary_exponent(exponential(x[l])));
      EXPECT_EQ(bits(sine[l]), bits(sinh_to_two(std::fabs(x[l]) * 0.02f)));
      EXPECT_EQ(bits(cosine[l]), bits(cosine_of_third(std::fabs(x[l]) * 0.01f)));
    }
  }
}

/* Every law, with lanes that yield in different ways beside lanes that do not. */
TEST(Pack, ReturnMappingsHaveTheBitsOfTheScalarText) {
  RandomTensors random(23);
  loam_material_def metal = default_material(LOAM_LAW_VON_MISES), thickening = default_material(LOAM_LAW_HERSCHEL_BULKLEY);
  metal.hardening_modulus = 1e5f;
  thickening.flow_exponent = 3;
  std::vector<loam_material_def> materials = {metal, thickening};
  for (std::uint32_t law = 0; law <= LOAM_LAW_STOMAKHIN_SNOW; ++law) materials.push_back(default_material(law));
  const double sizes[4] = {0.05, 1e-4, 0.2, 0.01}, histories[4] = {-0.002, 0.01, -0.01, 0};
  for (const loam_material_def &def : materials)
    for (int k = 0; k < 200; ++k) {
      float e[4][7];
      for (int l = 0; l < 4; ++l) {
        const test::Matrix strain = random.symmetric(random.vector(sizes[l]));
        const Sym3<float> d = test::narrow(test::deviator(strain));
        const float values[7] = {d.xx, d.yy, d.zz, d.xy, d.xz, d.yz, float(strain.trace())};
        std::copy(values, values + 7, e[l]);
      }
      const auto lanes = [&](int i) { return pack_of(e[0][i], e[1][i], e[2][i], e[3][i]); };
      const Pack history = pack_of(float(histories[0]), float(histories[1]), float(histories[2]), float(histories[3]));
      const HenckyStrain<Pack> trial = {lanes(6), tensor<Pack>(lanes)};
      std::visit(
          [&](const auto &law) {
            const Flow<Pack> flow = {1e-3f, Pack(0.7f), Pack(0.4f)};
            const Projection<Pack> packed = project(law, trial, Pack(1e-6f), history, flow);
            for (int l = 0; l < 4; ++l) {
              const HenckyStrain<float> one = {e[l][6], tensor<float>([&](int i) { return e[l][i]; })};
              const Projection<float> expected =
                  project(law, one, 1e-6f, float(histories[l]), Flow<float>{1e-3f, 0.7f, 0.4f});
              EXPECT_EQ(bits(Lanes(packed.strain.trace)[l]), bits(expected.strain.trace)) << def.law;
              EXPECT_EQ(bits(Lanes(packed.strain.deviator.xy)[l]), bits(expected.strain.deviator.xy)) << def.law;
              EXPECT_EQ(bits(Lanes(packed.scale)[l]), bits(expected.scale)) << def.law;
              EXPECT_EQ(bits(Lanes(packed.history)[l]), bits(expected.history)) << def.law;
            }
          },
          make_law(def));
    }
}

/* Rare paths are taken for all lanes as soon as one needs them. What they multiply by 0 may be infinite. */
TEST(Pack, ALaneWithoutUnknownDirectionsKeepsWhatItHas) {
  const float infinity = std::numeric_limits<float>::infinity();
  Mat3<Pack> H = zero_matrix<Pack>();
  H.m[0][1] = pack_of(infinity, 0.1f, -infinity, 3);
  const Vec3<Pack> q = {pack_of(0, 1, 0, 0), Pack(0.0f), Pack(0.0f)};
  for (const Mat3<Pack> &result : {complete_gradient(H, q), restrict_impulse(H, q)}) {
    const Lanes entry(result.m[0][1]), before(H.m[0][1]), other(result.m[1][0]);
    for (const int lane : {0, 2, 3}) {
      EXPECT_EQ(entry[lane], before[lane]) << lane;
      EXPECT_EQ(other[lane], 0) << lane;
    }
  }
}

} // namespace
} // namespace loam
