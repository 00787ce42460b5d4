/* Simple shear of a material point at a steady rate g: the shear stress is t + k g^n. */
#include <gtest/gtest.h>

#include "support/material_point.h"

namespace loam {
namespace {

using test::MaterialPoint;
using test::Matrix;

loam_material_def fluid(float exponent, float yield = 20, float consistency = 10) {
  loam_material_def def = default_material(LOAM_LAW_HERSCHEL_BULKLEY);
  def.youngs_modulus = 1e8f; // elastic strains are then small, as the formula has it
  def.shear_yield_stress = yield;
  def.consistency = consistency;
  def.flow_exponent = exponent;
  return def;
}

/* The shear stress at the rate g in 1/s, once it is steady. */
double shear_stress(const loam_material_def &def, double g) {
  MaterialPoint point(def);
  Matrix L = Matrix::Zero();
  L(0, 1) = g;
  const double h = 1e-3 / g;
  double before = -1;
  for (int step = 0; step < 4000; ++step) {
    point.deform(h * L, h);
    const double now = point.kirchhoff_stress()(0, 1);
    if (step % 100 == 99) {
      if (std::fabs(now - before) < 1e-5 * now) break;
      before = now;
    }
  }
  EXPECT_EQ(point.limited(), 0);
  return point.kirchhoff_stress()(0, 1);
}

TEST(HerschelBulkleyPoint, SteadyShearStressFollowsTheFlowCurve) {
  for (const float n : {0.3f, 1.0f, 3.0f})
    for (const double g : {0.1, 1.0, 5.0, 20.0}) {
      const double expected = 20 + 10 * std::pow(g, double(n));
      EXPECT_NEAR(shear_stress(fluid(n), g), expected, 0.01 * expected) << n << " " << g;
    }
}

TEST(HerschelBulkleyPoint, ExponentsAtTheEndsOfTheirRangeAndWithoutAYieldStress) {
  for (const float n : {0.1f, 0.5f, 2.0f, 10.0f})
    for (const double g : {0.5, 1.5}) {
      const double expected = 10 * std::pow(g, double(n));
      EXPECT_NEAR(shear_stress(fluid(n, 0), g), expected, 0.01 * expected) << n << " " << g;
    }
}

/* The controls: a tenth more of each parameter, and the factor between the norms forgotten, leave the band. */
TEST(HerschelBulkleyPoint, WrongParametersLeaveTheBand) {
  const double expected = 20 + 10 * std::pow(20.0, 0.3);
  EXPECT_GT(std::fabs(shear_stress(fluid(0.33f), 20) / expected - 1), 0.01);
  EXPECT_GT(std::fabs(shear_stress(fluid(0.3f, 22), 20) / expected - 1), 0.01);
  EXPECT_GT(std::fabs(shear_stress(fluid(0.3f, 20, 11), 20) / expected - 1), 0.01);
  EXPECT_GT(std::fabs(shear_stress(fluid(0.3f, 20, 10 / std::exp2(0.65f)), 20) / expected - 1), 0.01);
}

/* Below the yield stress it is elastic; left to itself after shear it relaxes to the yield stress and stays there. */
TEST(HerschelBulkleyPoint, ItStandsBelowItsYieldStressAndRelaxesDownToIt) {
  const loam_material_def def = fluid(0.3f);
  MaterialPoint point(def);
  Matrix H = Matrix::Zero();
  H(0, 1) = 10 / point.shear_modulus();
  point.deform(H, 1e-3);
  EXPECT_NEAR(point.kirchhoff_stress()(0, 1), 10, 0.01);
  for (int step = 0; step < 100; ++step) point.deform(Matrix::Zero(), 1e-2);
  EXPECT_NEAR(point.kirchhoff_stress()(0, 1), 10, 0.01);
  for (int step = 0; step < 10; ++step) point.deform(H, 1e-7); // 3 / s
  EXPECT_GT(point.kirchhoff_stress()(0, 1), 30);
  for (int step = 0; step < 200; ++step) point.deform(Matrix::Zero(), 1);
  EXPECT_NEAR(point.kirchhoff_stress()(0, 1), 20, 0.2);
}

} // namespace
} // namespace loam
