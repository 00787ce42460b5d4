/* How a step's velocity gradient advances the strain. */
#include <gtest/gtest.h>

#include "kernels/inelastic/kinematics.h"
#include "kernels/inelastic/scalar_multiplier.h"
#include "support/tensors.h"

namespace loam {
namespace {

using test::Matrix;
using test::RandomTensors;

TEST(Kinematics, TheStrainFollowsTheDeformationGradientToFloatAccuracy) {
  RandomTensors random(2);
  for (const double size : {1e-7, 1e-4, 1e-2, 0.3}) {
    for (int k = 0; k < 500; ++k) {
      const Matrix F = Matrix::Identity() + random.matrix(size), H = random.matrix(size);
      const Sym3<float> S = test::narrow(F * F.transpose() - Matrix::Identity());
      const Mat3<float> narrow_H = test::narrow_full(H);
      const Matrix D = Matrix::Identity() + test::widen(narrow_H);
      const Matrix expected = D * (test::widen(S) + Matrix::Identity()) * D.transpose() - Matrix::Identity();
      // relative to the strain, not to 1: this is what storing b - I is for
      EXPECT_LT((test::widen(advance_strain(S, narrow_H)) - expected).norm(), 1e-6 * 4 * size) << size;
    }
  }
}

TEST(Kinematics, ARotationOfAnUnstrainedPointLeavesRoundingOnly) {
  RandomTensors random(4);
  for (int k = 0; k < 200; ++k) {
    const Mat3<float> H = test::narrow_full(random.rotation() - Matrix::Identity());
    EXPECT_LT(test::widen(advance_strain(zero_symmetric<float>(), H)).norm(), 1e-6);
  }
}

TEST(Kinematics, InverseTranspose) {
  RandomTensors random(6);
  for (int k = 0; k < 500; ++k) {
    const Mat3<float> H = test::narrow_full(random.matrix(0.2));
    const Matrix D = Matrix::Identity() + test::widen(H);
    EXPECT_LT((test::widen(inverse_transpose(H)) - D.inverse().transpose()).norm(), 1e-5);
  }
  // Near inversion the inverse says nothing: the identity stands in, and is finite.
  const Mat3<float> flat = {{{-1, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, inverted = {{{-2, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
  for (const Mat3<float> &H : {flat, inverted})
    EXPECT_EQ((test::widen(inverse_transpose(H)) - Matrix::Identity()).norm(), 0);
}

} // namespace
} // namespace loam
