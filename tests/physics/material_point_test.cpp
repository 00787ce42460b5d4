/* One material point of each solid law under a prescribed velocity gradient, against the law's closed form in double precision. Each band has its
 * negative control beside it. */
#include <gtest/gtest.h>

#include "support/material_point.h"

namespace loam {
namespace {

using test::MaterialPoint;
using test::Matrix;
using test::Vector;

Matrix diagonal(double x, double y, double z) { return Vector(x, y, z).asDiagonal(); }

/* ------------------------------------------------------------------------------------------------- Von Mises --- */

loam_material_def metal(float hardening) {
  loam_material_def def = default_material(LOAM_LAW_VON_MISES); // E 1 MPa
  def.yield_stress = 5e3f;
  def.hardening_modulus = hardening;
  return def;
}

/* Stretched by `strain` without change of volume, in n steps. */
MaterialPoint stretched(const loam_material_def &def, double strain, int n) {
  MaterialPoint point(def);
  const double d = strain / n, across = std::expm1(-d / 2);
  for (int step = 0; step < n; ++step) point.deform(diagonal(std::expm1(d), across, across));
  return point;
}

/* Elastic up to yield, then stress = yield_stress + hardening p with p what is not elastic of the strain. */
double stress_of_bar(const loam_material_def &def, double mu, double strain) {
  const double yield = double(def.yield_stress), hardening = double(def.hardening_modulus);
  const double p = std::max(0.0, (3 * mu * strain - yield) / (3 * mu + hardening));
  return 3 * mu * (strain - p);
}

TEST(VonMisesPoint, ABarHardensInProportionToItsPlasticStrain) {
  for (const float hardening : {0.0f, 2e4f, 2e5f})
    for (const int steps : {5, 200}) {
      const MaterialPoint point = stretched(metal(hardening), 0.3, steps);
      const double expected = stress_of_bar(metal(hardening), point.shear_modulus(), 0.3);
      EXPECT_NEAR(point.equivalent_stress(), expected, 1e-3 * expected) << hardening << " " << steps;
      if (hardening > 0) {
        EXPECT_NEAR(point.history(), (expected - 5e3) / double(hardening), 1e-3) << hardening;
      }
    }
  // The controls: without hardening, and with the strain's Frobenius norm for the equivalent strain, sqrt(3/2) of it.
  const double hard = stress_of_bar(metal(2e4f), 1e6 / 2.6, 0.3), without = stress_of_bar(metal(0), 1e6 / 2.6, 0.3);
  EXPECT_GT(hard / without, 2);
  EXPECT_GT(std::fabs((5e3 + (hard - 5e3) * std::sqrt(1.5)) / hard - 1), 0.01);
}

TEST(VonMisesPoint, ItHasHardenedForBothDirections) {
  MaterialPoint point = stretched(metal(2e4f), 0.1, 50);
  const double reached = point.equivalent_stress();
  // Back by two elastic strains of the stress reached, and 0.01 more: it yields again at no less than where it stopped.
  const double back = 2 * reached / (3 * point.shear_modulus()) + 0.01;
  for (int step = 0; step < 50; ++step)
    point.deform(diagonal(std::expm1(-back / 50), std::expm1(back / 100), std::expm1(back / 100)));
  const double again = reached + 2e4 * 0.01 / (1 + 2e4 / (3 * point.shear_modulus()));
  EXPECT_NEAR(point.equivalent_stress(), again, 1e-3 * again);
  EXPECT_LT(point.kirchhoff_stress()(0, 0), 0);
}

/* -------------------------------------------------------------------------------------------- Drucker-Prager --- */

double triaxial_ratio(float degrees) {
  loam_material_def def = default_material(LOAM_LAW_DRUCKER_PRAGER);
  def.friction_angle = degrees * 3.14159265f / 180;
  MaterialPoint point(def);
  for (int step = 0; step < 400; ++step) point.deform(diagonal(-5e-4, 1e-4, 1e-4));
  return point.equivalent_stress() / point.pressure();
}

TEST(DruckerPragerPoint, TriaxialCompressionReachesTheSlopeOfTheFrictionAngle) {
  for (const float degrees : {20.0f, 30.0f, 40.0f}) {
    const double sine = std::sin(double(degrees) * 3.14159265 / 180), slope = 6 * sine / (3 - sine);
    EXPECT_NEAR(triaxial_ratio(degrees), slope, 0.01 * slope) << degrees;
    EXPECT_GT(std::fabs(triaxial_ratio(degrees + 1) - slope), 0.01 * slope); // the control: a degree more
  }
}

/* ------------------------------------------------------------------------------------------------------ NACC --- */

loam_material_def clay(bool constant) {
  loam_material_def def = default_material(LOAM_LAW_NACC);
  def.consolidation = -0.01f;
  def.cohesion_ratio = 0.5f;
  def.hardening_factor = 10;
  def.critical_state_slope = 1.4f;
  def.constant_hardness = constant ? 1 : 0;
  return def;
}
/* p0 over K. */
double size_of_ellipse(double alpha, double hardening) { return 1e-5 + std::sinh(hardening * std::max(-alpha, 0.0)); }

/* (1 + 2 b) q^2 + M^2 (p + b p0)(p - p0), over M^2 p0^2. */
double ellipse_residual(const MaterialPoint &point, const loam_material_def &def, double alpha) {
  const double b = double(def.cohesion_ratio), M = double(def.critical_state_slope);
  const double p0 = point.bulk() * size_of_ellipse(alpha, double(def.hardening_factor));
  const double p = point.pressure(), q = point.equivalent_stress();
  return ((1 + 2 * b) * q * q + M * M * (p + b * p0) * (p - p0)) / (M * M * p0 * p0);
}

TEST(NaccPoint, StressStaysOnTheEllipseWhileItYields) {
  test::RandomTensors random(3);
  int on_the_side = 0;
  for (int path = 0; path < 60; ++path) {
    MaterialPoint point(clay(false));
    const Matrix any = random.symmetric(random.vector(1)),
                 direction = test::deviator(any) + 0.1 * any.trace() * Matrix::Identity();
    for (int step = 0; step < 30; ++step) {
      const double before = point.history();
      point.deform(8e-3 * direction);
      const double change = std::fabs(point.history() - before);
      if (change == 0) {
        EXPECT_LT(ellipse_residual(point, clay(false), before), 1e-3); // elastic: inside
      } else if (point.equivalent_stress() > 1 && size_of_ellipse(before, 10) > 1e-3) {
        ++on_the_side;
        EXPECT_NEAR(ellipse_residual(point, clay(false), before), 0, 1e-3) << path << " " << step;
      }
    }
  }
  EXPECT_GT(on_the_side, 100);
  // The control: against the ellipse of beta = 0.45 the same stress is off by more than a hundredth.
  MaterialPoint point(clay(true));
  for (int step = 0; step < 50; ++step) point.deform(diagonal(2e-3, -1e-3, -1e-3));
  loam_material_def wrong = clay(true);
  EXPECT_NEAR(ellipse_residual(point, wrong, -0.01), 0, 1e-3);
  wrong.cohesion_ratio = 0.45f;
  EXPECT_GT(std::fabs(ellipse_residual(point, wrong, -0.01)), 0.01);
}

/* The shear stress borne at a given pressure, in units of p0, with constant hardness. */
double greatest_shear(double pressure_over_p0) {
  MaterialPoint point(clay(true));
  const double p = pressure_over_p0 * size_of_ellipse(-0.01, 10);
  for (int step = 0; step < 20; ++step) point.deform(std::expm1(-p / 60) * Matrix::Identity());
  for (int step = 0; step < 100; ++step) point.deform(diagonal(std::expm1(2e-3), std::expm1(-1e-3), std::expm1(-1e-3)));
  return point.equivalent_stress() / (point.bulk() * size_of_ellipse(-0.01, 10));
}

TEST(NaccPoint, BearsTheMostShearHalfwayBetweenItsTips) {
  // b = 0.5: the ellipse's centre is at p0 (1 - b) / 2 = 0.25 p0, and there q = M p0 (1 + b) / (2 sqrt(1 + 2 b)).
  const double most = 1.4 * 1.5 / (2 * std::sqrt(2.0));
  EXPECT_NEAR(greatest_shear(0.25), most, 0.01 * most);
  // The controls: a fifth of p0 to either side it is 1 - (0.2 / 0.75)^2 under the root, and the same on both.
  const double beside = most * std::sqrt(1 - (0.2 / 0.75) * (0.2 / 0.75));
  EXPECT_NEAR(greatest_shear(0.05), beside, 0.01 * most);
  EXPECT_NEAR(greatest_shear(0.45), beside, 0.01 * most);
  EXPECT_LT(beside, 0.98 * most);
}

TEST(NaccPoint, ShearedLongEnoughItReachesTheCriticalState) {
  // Where the ellipse has its centre, shear changes the volume no more: q / p = M (1 + b) / ((1 - b) sqrt(1 + 2 b)).
  for (const double compressed : {0.02, 0.06}) { // to p of 0.2 and 0.6 p0
    MaterialPoint point(clay(false));
    for (int step = 0; step < 20; ++step) point.deform(std::expm1(-compressed / 60) * Matrix::Identity());
    for (int step = 0; step < 4000; ++step) point.deform(diagonal(std::expm1(2e-3), std::expm1(-1e-3), std::expm1(-1e-3)));
    const double ratio = point.equivalent_stress() / point.pressure(), expected = 1.4 * 1.5 / (0.5 * std::sqrt(2.0));
    EXPECT_NEAR(ratio, expected, 0.01 * expected) << compressed;
  }
}

/* The pressure over K under compression from all sides: on the tip elastic and plastic strain add up to what was imposed, t + alpha = alpha_0 + V. */
double tip_pressure(double alpha_0, double hardening, double log_volume) {
  double low = -1, high = 0; // alpha
  for (int k = 0; k < 100; ++k) {
    const double alpha = (low + high) / 2, missing = -size_of_ellipse(alpha, hardening) + alpha - alpha_0 - log_volume;
    (missing > 0 ? high : low) = alpha;
  }
  return size_of_ellipse(low, hardening);
}

TEST(NaccPoint, CompactionHardensItAsItsEquationSaysWhateverTheStep) {
  for (const double hardening : {3.0, 10.0, 30.0}) {
    loam_material_def def = clay(false);
    def.hardening_factor = float(hardening);
    const double expected = tip_pressure(-0.01, hardening, -0.3);
    for (const int steps : {6, 30, 1000}) {
      MaterialPoint point(def);
      for (int step = 0; step < steps; ++step) point.deform(std::expm1(-0.1 / steps) * Matrix::Identity());
      EXPECT_NEAR(point.pressure() / point.bulk(), expected, 2e-3 * expected) << hardening << " " << steps;
      EXPECT_NEAR(point.history(), -0.3 - 0.01 + expected, 1e-3) << hardening << " " << steps;
      EXPECT_EQ(point.limited(), 0);
    }
    if (hardening > 20) continue; // so hard that there is little to overshoot
    // The control: hardening by the size before the step, in six steps.
    double t = 0, alpha = -0.01;
    for (int step = 0; step < 6; ++step) {
      t -= 0.05;
      const double size = size_of_ellipse(alpha, hardening);
      if (-t <= size) continue;
      alpha += t + size;
      t = -size;
    }
    EXPECT_GT(std::fabs(-t / expected - 1), 0.02) << hardening;
  }
}

TEST(NaccPoint, OpeningTakesItsStrengthAndConstantHardnessKeepsIt) {
  MaterialPoint breaking(clay(false)), lasting(clay(true));
  for (int step = 0; step < 100; ++step) {
    breaking.deform(1e-3 * Matrix::Identity());
    lasting.deform(1e-3 * Matrix::Identity());
  }
  const double strength = 0.5 * size_of_ellipse(-0.01, 10);
  EXPECT_NEAR(-lasting.pressure() / lasting.bulk(), strength, 0.01 * strength);
  EXPECT_NEAR(lasting.history(), -0.01, 1e-9);
  EXPECT_LT(-breaking.pressure() / breaking.bulk(), 1e-4 * strength + 1e-5);
  EXPECT_NEAR(breaking.history(), -0.01 + 0.3, 1e-3); // all the opening
  // Loose matter is brought together again without resistance, and bears load from where it was whole.
  for (int step = 0; step < 60; ++step) breaking.deform((1 / 1.001 - 1) * Matrix::Identity());
  EXPECT_LT(breaking.pressure() / breaking.bulk(), 2e-5);
  for (int step = 0; step < 100; ++step) breaking.deform((1 / 1.001 - 1) * Matrix::Identity());
  EXPECT_GT(breaking.pressure() / breaking.bulk(), 0.05);
}

/* ------------------------------------------------------------------------------------------- Stomakhin's snow --- */

TEST(StomakhinSnowPoint, PrincipalStretchesStayInTheBoxInAnyDirection) {
  test::RandomTensors random(8);
  const loam_material_def def = default_material(LOAM_LAW_STOMAKHIN_SNOW);
  const double least = std::log(1 - 0.025), most = std::log(1 + 0.0075);
  for (int path = 0; path < 20; ++path) {
    const Matrix R = random.rotation(), L = R * diagonal(-3e-3, 1e-3, 2e-4) * R.transpose();
    MaterialPoint point(def);
    double elastic_volume = 0;
    for (int step = 0; step < 20; ++step) point.deform(L);
    const Vector e = Eigen::SelfAdjointEigenSolver<Matrix>(point.hencky_strain()).eigenvalues();
    EXPECT_NEAR(e[0], least, 1e-5);
    EXPECT_NEAR(e[1], 20 * std::log1p(2e-4), 1e-5);
    EXPECT_NEAR(e[2], most, 1e-5);
    // What the box discards is plastic: J = J_e J_p; and it is packed snow now, the harder for it.
    elastic_volume = std::exp(e.sum());
    const double J = std::pow((1 - 3e-3) * (1 + 1e-3) * (1 + 2e-4), 20);
    EXPECT_NEAR(1 + point.history(), J / elastic_volume, 1e-4);
    const double tension = point.kirchhoff_stress().trace() / (3 * point.bulk() * e.sum());
    EXPECT_NEAR(tension, std::exp(10 * (1 - J / elastic_volume)), 2e-3);
    EXPECT_GT(tension, 1.05); // the control: without hardening it would be 1
  }
}

TEST(StomakhinSnowPoint, WithinTheBoxItIsElastic) {
  MaterialPoint point(default_material(LOAM_LAW_STOMAKHIN_SNOW));
  for (int step = 0; step < 10; ++step) point.deform(diagonal(-2e-3, 5e-4, 5e-4));
  EXPECT_EQ(point.history(), 0);
  EXPECT_NEAR(point.hencky_strain()(0, 0), 10 * std::log1p(-2e-3), 1e-6);
}

TEST(StomakhinSnowPoint, ItsHardeningIsBounded) {
  MaterialPoint point(default_material(LOAM_LAW_STOMAKHIN_SNOW));
  for (int step = 0; step < 200; ++step) point.deform(-0.01 * Matrix::Identity());
  const double e = 3 * std::log(1 - 0.025);
  EXPECT_NEAR(point.pressure() / (-point.bulk() * e), std::exp(3.0), 0.01 * std::exp(3.0)); // not exp(10)
}

} // namespace
} // namespace loam
