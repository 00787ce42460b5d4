/* Sand that is pulled apart and pushed together again must come back without pressure. The end-of-substep kernel alone, on one neighbourhood. */
#include <gtest/gtest.h>

#include "support/material_point.h"

namespace loam {
namespace {

using test::MaterialPoint;
using test::Matrix;

/* The pressure left after three cycles of 0.1 of stretch in all directions and back. */
double pressure_after_cycles(bool corrected) {
  MaterialPoint point(default_material(LOAM_LAW_DRUCKER_PRAGER));
  const auto deform = [&](const Matrix &H) {
    if (!corrected) point.set_history(0);
    point.deform(H);
  };
  for (int cycle = 0; cycle < 3; ++cycle) {
    for (int step = 0; step < 1000; ++step) deform(1e-4 * Matrix::Identity());
    for (int step = 0; step < 1000; ++step) deform(Matrix::Identity() / 1.0001 - Matrix::Identity());
  }
  EXPECT_NEAR(point.log_volume(), 0, 1e-4); // the true volume is back
  return point.pressure();
}

TEST(VolumeCorrection, CyclesOfStretchLeaveNoPressure) { EXPECT_LT(std::fabs(pressure_after_cycles(true)), 1e3); }

TEST(VolumeCorrection, WithoutItTheyWouldLeaveAHundredKilopascals) { EXPECT_GT(pressure_after_cycles(false), 1e5); }

TEST(VolumeCorrection, ExpansionMustBeUndoneBeforePressureBuildsUp) {
  MaterialPoint point(default_material(LOAM_LAW_DRUCKER_PRAGER));
  point.deform(0.02 * Matrix::Identity());
  EXPECT_NEAR(point.pressure(), 0, 1);
  point.deform(-0.01 * Matrix::Identity());
  EXPECT_NEAR(point.pressure(), 0, 1); // still looser than at the start
  point.deform(-0.02 * Matrix::Identity());
  EXPECT_NEAR(point.pressure(), 1e6 / 1.2 * -3 * std::log(1.02 * 0.99 * 0.98), 2000);
}

} // namespace
} // namespace loam
