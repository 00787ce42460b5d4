/* Functions of symmetric tensors in float against Eigen in double. The bounds are twice what was measured. */
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "math/tensor_functions.h"
#include "support/tensors.h"

namespace loam {
namespace {

using test::Matrix;
using test::RandomTensors;
using test::Vector;

Matrix reference_hencky(const Sym3<float> &S) {
  return test::apply(test::widen(S), [](double x) { return 0.5 * std::log1p(x); });
}

/* The greatest error of hencky_strain relative to the strain's norm, over strains of about `size`. */
double hencky_error(double size, StrainLimit limit, bool expect_limited = false) {
  RandomTensors random(7);
  double worst = 0;
  for (int k = 0; k < 2000; ++k) {
    const Matrix e = random.symmetric(random.vector(size));
    Sym3<float> S = test::narrow(test::apply(e, [](double x) { return std::expm1(2 * x); }));
    const Matrix reference = reference_hencky(S);
    bool limited = false;
    const HenckyStrain<float> strain = hencky_strain(S, limit, limited);
    EXPECT_EQ(limited, expect_limited);
    Matrix found = test::widen(strain.deviator) + double(strain.trace) / 3 * Matrix::Identity();
    EXPECT_LE(std::fabs(test::widen(strain.deviator).trace()), 1e-6 * std::max(size, 1e-20) * 4);
    worst = std::max(worst, (found - reference).norm() / reference.norm());
  }
  return worst;
}

TEST(Tensor, HenckyStrainOfSmallStrainsKeepsItsRelativeAccuracy) {
  for (const double size : {1e-12, 1e-8, 1e-5, 1e-3, 1e-2, 0.1})
    EXPECT_LT(hencky_error(size, strain_limit(2)), 2e-6) << size;
}

TEST(Tensor, HenckyStrainBeyondThePolynomialsRange) {
  // log_by_roots has an absolute error of 4e-6
  EXPECT_LT(hencky_error(0.4, strain_limit(2)), 2e-4);
  EXPECT_LT(hencky_error(1.5, strain_limit(2)), 2e-4);
}

TEST(Tensor, HenckyStrainClampsPrincipalStrainsToTheLimit) {
  RandomTensors random(3);
  for (int k = 0; k < 500; ++k) {
    const Vector principal = {random.between(0.6, 1.5), random.between(-0.3, 0.3), random.between(-1.5, -0.6)};
    const Matrix e = random.symmetric(principal);
    Sym3<float> S = test::narrow(test::apply(e, [](double x) { return std::expm1(2 * x); }));
    bool limited = false;
    const HenckyStrain<float> strain = hencky_strain(S, strain_limit(0.5), limited);
    EXPECT_TRUE(limited);
    const Matrix expected = test::apply(e, [](double x) { return std::clamp(x, -0.5, 0.5); });
    EXPECT_LT((test::widen(strain.deviator) + double(strain.trace) / 3 * Matrix::Identity() - expected).norm(), 3e-5);
    EXPECT_LT((reference_hencky(S) - expected).norm(), 3e-5); // S agrees
  }
}

TEST(Tensor, AnInvertedOrNonFiniteStrainEndsAtTheLowerLimit) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const float bad : {-1.0f, -3.0f, -1e20f, nan, -inf}) {
    Sym3<float> S = {bad, bad, bad, 0, 0, 0};
    bool limited = false;
    const HenckyStrain<float> strain = hencky_strain(S, strain_limit(0.5), limited);
    EXPECT_NEAR(strain.trace, -1.5f, 1e-4) << bad;
    if (!std::isfinite(bad)) continue;
    EXPECT_TRUE(limited) << bad;
    EXPECT_NEAR(S.xx, std::expm1(-1.0), 1e-5) << bad;
  }
}

TEST(Tensor, ExponentialOfATracelessTensor) {
  RandomTensors random(11);
  for (const double size : {1e-8, 1e-4, 0.1, 0.5}) {
    double worst = 0;
    for (int k = 0; k < 1000; ++k) {
      const Matrix X = test::deviator(random.symmetric(random.vector(size)));
      const Sym3<float> narrowed = test::narrow(X);
      const Matrix reference = test::apply(test::widen(narrowed), [](double x) { return std::expm1(x); });
      worst = std::max(worst, (test::widen(expm1_traceless(narrowed)) - reference).norm() / reference.norm());
    }
    EXPECT_LT(worst, 1e-6) << size;
  }
}

TEST(Tensor, ScalarLogarithmsAndExponentials) {
  for (double x = -0.34; x < 0.45; x += 0.001)
    EXPECT_NEAR(log1p_bounded(float(x)), std::log1p(double(float(x))), 3e-7 * std::fabs(x) + 1e-12) << x;
  for (double x = -0.89; x < 9; x += 0.01) EXPECT_NEAR(log1p_bounded(float(x)), std::log1p(double(float(x))), 1e-5) << x;
  EXPECT_NEAR(log1p_bounded(-5.0f), std::log(0.1), 1e-5);
  EXPECT_NEAR(log1p_bounded(1e10f), std::log(10.0), 1e-5);
  for (double x = -1; x <= 1; x += 0.01)
    EXPECT_NEAR(expm1_series(float(x)), std::expm1(double(float(x))), 4e-7 * std::fabs(std::expm1(x)) + 1e-12) << x;
  EXPECT_NEAR(expm1_series(2.0f), std::expm1(2.0), 1e-3);
}

TEST(Tensor, EigenDecompositionOfAnyMatrix) {
  RandomTensors random(5);
  const auto check = [](const Matrix &a, const char *what) {
    const Eigen3<float> eigen = eigen_decomposition(test::narrow(a));
    const Matrix V = test::widen(eigen.vectors);
    const Vector values(double(eigen.values[0]), double(eigen.values[1]), double(eigen.values[2]));
    const Matrix narrowed = test::widen(test::narrow(a));
    EXPECT_LT((V * values.asDiagonal() * V.transpose() - narrowed).norm(), 3e-6 * narrowed.norm()) << what;
    EXPECT_LT((V.transpose() * V - Matrix::Identity()).norm(), 3e-6) << what;
  };
  for (const double size : {1e-12, 1e-3, 1.0, 1e6})
    for (int k = 0; k < 300; ++k) check(size * random.symmetric(random.vector(1)), "random");
  for (int k = 0; k < 300; ++k) {
    check(random.symmetric({1, 1, random.between(-2, 2)}), "two equal eigenvalues");
    check(random.symmetric({1, 1 + 1e-6, 1e-6}), "two nearly equal eigenvalues");
    check(random.symmetric({1e6, 1, 1e-6}), "wide spread");
    check(random.symmetric({1, 0, 0}), "rank one");
  }
  check(Matrix::Identity(), "identity");
  check(Vector(3, 2, 1).asDiagonal(), "diagonal");
}

} // namespace
} // namespace loam
