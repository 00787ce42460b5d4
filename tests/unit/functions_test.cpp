/* Our own elementary functions in float against the standard library in double. The bounds stand beside the functions. */
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "kernels/materials/herschel_bulkley.h"
#include "math/functions.h"
#include "math/tensor_functions.h"
#include "support/tensors.h"

namespace loam {
namespace {

TEST(Functions, PowersOfTwoAndExponentsAreExact) {
  for (int n = -126; n <= 127; ++n) EXPECT_EQ(power_of_two(float(n)), std::ldexp(1.0f, n));
  for (double a = 1.3e-38; a < 3e38; a *= 1.37) {
    const double m = double(float(a)) / std::exp2(double(binary_exponent(float(a))));
    EXPECT_GT(m, 0.7071067);
    EXPECT_LT(m, 1.4142137);
  }
}

TEST(Functions, Logarithm) {
  for (double a = 1.3e-38; a < 9.9e37; a *= 1.013) {
    const double expected = std::log(double(float(a)));
    EXPECT_NEAR(double(logarithm(float(a))), expected, 6e-8 + 1e-7 * std::fabs(expected)) << a;
  }
  for (double x = -0.3; x < 0.4; x += 1e-4)
    EXPECT_NEAR(double(logarithm(float(1 + x))), std::log(double(float(1 + x))), 6e-8);
  EXPECT_EQ(logarithm(1.0f), 0.0f);
  const float least = logarithm(1.2e-38f);
  for (const float bad : {0.0f, -1.0f, -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
    EXPECT_EQ(logarithm(bad), least);
  EXPECT_NEAR(logarithm(std::numeric_limits<float>::infinity()), std::log(1e38), 1e-4);
}

TEST(Functions, Exponential) {
  for (double a = -87; a < 88; a += 0.0037) {
    const double expected = std::exp(double(float(a)));
    EXPECT_NEAR(double(exponential(float(a))), expected, 2e-7 * expected) << a;
  }
  EXPECT_EQ(exponential(0.0f), 1.0f);
  EXPECT_EQ(exponential(1e30f), exponential(88.0f));
  EXPECT_EQ(exponential(-1e30f), exponential(-87.0f));
  EXPECT_EQ(exponential(std::numeric_limits<float>::quiet_NaN()), exponential(-87.0f));
}

TEST(Functions, HyperbolicSine) {
  for (double a = 0; a <= 2; a += 0.001) {
    const double expected = std::sinh(double(float(a)));
    EXPECT_NEAR(double(sinh_to_two(float(a))), expected, 3e-7 * expected);
  }
}

TEST(Functions, CosineOfAThirdOfAnAngle) {
  for (double x = 0; x <= 1; x += 1e-4)
    EXPECT_NEAR(double(cosine_of_third(float(x))), std::cos(std::acos(std::min(1.0, double(float(x)))) / 3), 2e-7) << x;
}

/* z + exp(a) z^k = 1, by bisection in the logarithm of z. */
double root_of_balance(double a, double k) {
  double low = -300, high = 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (std::exp(middle) + std::exp(a + k * middle) > 1 ? high : low) = middle;
  }
  return std::exp(low);
}

TEST(Functions, RootOfThePowerBalance) {
  const std::pair<float, double> bounds[] = {{1.1f, 2e-6}, {2, 2e-6}, {3, 2e-6}, {1 / 0.3f, 2e-6}, {5, 5e-6}, {10, 3e-5}};
  for (const auto &[k, bound] : bounds)
    for (float a = -40; a < 40; a += 0.1f) {
      const double expected = root_of_balance(double(a), double(k)),
                   power = std::exp(double(a)) * std::pow(expected, double(k));
      const PowerBalance<float> found = solve_power_balance(a, k);
      EXPECT_NEAR(double(found.z), expected, bound * expected) << k << " " << a;
      EXPECT_NEAR(double(found.power), power, 12 * bound * power) << k << " " << a;
    }
}

TEST(Functions, SpectrumOfATracelessTensor) {
  test::RandomTensors random(9);
  const auto check = [](const test::Matrix &given, const char *what) {
    const Sym3<float> a = test::narrow(test::deviator(given));
    const test::Matrix A = test::widen(a);
    const Spectrum<float> s = spectrum_of_traceless(a);
    const test::Vector values = Eigen::SelfAdjointEigenSolver<test::Matrix>(A).eigenvalues(); // ascending
    double found[3] = {double(s.values[0]), double(s.values[1]), double(s.values[2])};
    std::sort(found, found + 3);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], values[k], 3e-6 * A.norm()) << what;
    // The identity comes back, and a clamp of the values is that in double precision.
    EXPECT_LT((test::widen(with_values(s, s.values)) - A).norm(), 3e-6 * A.norm()) << what;
    const double bound = 0.4 * A.norm();
    float clamped[3];
    for (int k = 0; k < 3; ++k) clamped[k] = std::clamp(s.values[k], -float(bound), float(bound));
    const test::Matrix expected = test::apply(A, [&](double x) { return std::clamp(x, -bound, bound); });
    EXPECT_LT((test::widen(with_values(s, clamped)) - expected).norm(), 1e-5 * A.norm()) << what;
  };
  for (const double size : {1e-9, 1e-3, 1.0})
    for (int k = 0; k < 500; ++k) check(size * random.symmetric(random.vector(1)), "random");
  for (int k = 0; k < 500; ++k) {
    check(0.02 * random.symmetric({1, 1, random.between(-2, 2)}), "two equal");
    check(0.02 * random.symmetric({1, 1 + 1e-5, random.between(-2, 2)}), "two nearly equal");
    check(0.02 * random.symmetric({1, 0, -1}), "determinant 0");
  }
  check(test::Vector(3, 2, 1).asDiagonal(), "diagonal");
  const Spectrum<float> none = spectrum_of_traceless(zero_symmetric<float>());
  const float values[3] = {0.5f, 0.5f, 0.5f};
  EXPECT_NEAR((test::widen(with_values(none, values)) - 0.5 * test::Matrix::Identity()).norm(), 0, 1e-6);
  for (const float value : none.values) EXPECT_EQ(value, 0.0f);
}

} // namespace
} // namespace loam
