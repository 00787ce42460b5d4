/* How a step's velocity gradient advances the strain. */
#include <gtest/gtest.h>

#include "kernels/inelastic/deformation.h"
#include "kernels/inelastic/kinematics.h"
#include "support/tensors.h"

namespace loam {
namespace {

using test::Matrix;
using test::RandomTensors;
using test::Vector;

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
    EXPECT_LT((test::widen(deformation(H).inverse_transpose) - D.inverse().transpose()).norm(), 1e-5);
  }
  // Near inversion the inverse says nothing: the identity stands in, and is finite.
  const Mat3<float> flat = {{{-1, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, inverted = {{{-2, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
  for (const Mat3<float> &H : {flat, inverted})
    EXPECT_EQ((test::widen(deformation(H).inverse_transpose) - Matrix::Identity()).norm(), 0);
}

// Of a neighbourhood in a plane or on a line, a rotation must look like a rotation: without completion it looks like a shear.
TEST(Kinematics, ARotationSeenInPartIsCompletedToARotation) {
  RandomTensors random(7);
  for (int k = 0; k < 100; ++k) {
    const Matrix axes = random.rotation();
    const Vector w = random.vector(0.1);
    Matrix spin;
    spin << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
    for (const int known : {1, 2}) {
      Matrix projector = Matrix::Zero();
      for (int i = 0; i < known; ++i) projector += axes.col(i) * axes.col(i).transpose();
      const Vector q = known == 2 ? Vector(axes.col(2)) : Vector(2 * axes.col(0));
      const Vec3<float> unknown = {float(q.x()), float(q.y()), float(q.z())};
      const Matrix seen = spin * projector;
      const Matrix completed = test::widen(complete_gradient(test::narrow_full(seen), unknown));
      EXPECT_GT((seen + seen.transpose()).norm(), 1e-3 * spin.norm());
      EXPECT_LT((completed + completed.transpose()).norm(), 1e-6);
      EXPECT_LT(((completed - spin) * projector).norm(), 1e-6); // what is known stays

      // An impulse works against the seen motion as the unrestricted one works against the completed: they are transposed.
      const Matrix T = random.matrix(1), H = random.matrix(1) * projector;
      const double work = T.cwiseProduct(test::widen(complete_gradient(test::narrow_full(H), unknown))).sum();
      EXPECT_NEAR(test::widen(restrict_impulse(test::narrow_full(T), unknown)).cwiseProduct(H).sum(), work, 1e-5);
    }
  }
}

} // namespace
} // namespace loam
